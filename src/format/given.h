/*
 * Parameter lists made by readers of other formats than pbrt's. Each name is given once,
 * so that adding can only fail for want of memory, which small lists do not meet.
 */
#pragma once

#include "params/params.h"

static inline void give_float(params *p, const char *name, double value)
{
    float x = (float)value;
    params_add_numbers(p, p->place, PARAM_FLOAT, name, &x, 1, NULL);
}

static inline void give_integer(params *p, const char *name, int value)
{
    params_add_integers(p, p->place, PARAM_INTEGER, name, &value, 1, NULL);
}

static inline void give_bool(params *p, const char *name, bool value)
{
    int x = value;
    params_add_integers(p, p->place, PARAM_BOOL, name, &x, 1, NULL);
}

static inline void give_text(params *p, param_type type, const char *name,
                             const char *value)
{
    params_add_strings(p, p->place, type, name, &value, 1, NULL);
}

static inline void give_triple(params *p, param_type type, const char *name, double x,
                               double y, double z)
{
    float all[3] = {(float)x, (float)y, (float)z};
    params_add_numbers(p, p->place, type, name, all, 3, NULL);
}
