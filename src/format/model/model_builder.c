/*
 * What all parts that make a scene of a model need.
 */
#include "format/model/model_scene.h"

#include "base/intern.h"

#include <string.h>

params *model_params(const model_builder *b)
{
    return params_new((source_place){intern(b->path), 0, 0}, b->directory,
                      color_space_srgb());
}

void model_tell(model_builder *b, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = g_strdup_vprintf(format, args);
    va_end(args);
    if (!g_hash_table_contains(b->notes, text))
        log_message(&b->builder->build.log, LOG_WARNING, "%s: %s", b->path, text);
    g_hash_table_add(b->notes, text);
}

bool model_transform(const double rows[16], transform *out)
{
    double m[4][4];
    memcpy(m, rows, sizeof m);
    return transform_from_matrix((const double(*)[4])m, out);
}
