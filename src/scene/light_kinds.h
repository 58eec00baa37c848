/*
 * The kinds of lights, one file each; light.c has the table. And the emitter: the
 * spectrum with its scale that all of them hold.
 */
#pragma once

#include "scene/light.h"

extern const light_kind point_light_kind;
extern const light_kind spot_light_kind;
extern const light_kind distant_light_kind;
extern const light_kind infinite_light_kind;
extern const light_kind area_light_kind;

/**
 * @brief What a light sends out: radiance, intensity or irradiance, as a spectrum times a
 * scale. pbrt-v4's scale: the spectrum is divided by its photometric integral (an rgb
 * one by that of its white alone), so that "scale" 1 has Y = 1.
 */
typedef struct emitter {
    curve *spectrum; /**< owned */
    float scale;
} emitter;

/** @brief Reads the spectrum `name` (default: the colour space's white) and "scale". */
bool emitter_init(emitter *e, const params *p, const char *name, GError **error);
/** @brief Reads `name` ("power", "illuminance"), which if given rescales such that the
 * emitter's Y times k_e is that number. */
bool emitter_set_total(emitter *e, const params *p, const char *name, float k_e,
                       GError **error);
spectrum emitter_eval(const emitter *e, const wavelengths *w);
void emitter_clear(emitter *e);

/** @brief false with ERROR_INPUT at the parameter's place if it is given. */
bool light_refuse(const params *p, const char *name, const char *what, GError **error);

/** @brief A disk that covers the scene's bounding sphere, seen from where distant light
 * comes: the start of a ray along direction, through disk coordinates or through a given
 * point. */
typedef struct light_disk {
    vec3 center;
    float radius;
} light_disk;

vec3 light_disk_start(const light_disk *disk, vec3 direction, vec2 u);
vec3 light_disk_before(const light_disk *disk, vec3 direction, vec3 target);
float light_disk_area(const light_disk *disk);
