/*
 * The kinds of lights, one file each; light.c has the table. And the emitter: the
 * spectrum with its scale that all of them hold.
 */
#pragma once

#include "light/light.h"

#define LIGHT(kind, file) extern const light_kind light_##kind;
#include "light/light.def"
#undef LIGHT

/**
 * @brief What a light sends out: radiance, intensity or irradiance, as a spectrum times a
 * scale. pbrt-v4's scale: the spectrum is divided by its photometric integral (an rgb
 * one by that of its white alone), so that "scale" 1 has Y = 1.
 */
typedef struct emitter {
    curve *spectrum; /**< owned */
    float scale;
} emitter;

/** @brief Reads the spectrum `name` and "scale".
 *  @param name NULL: there is none to read
 *  @param space whose white it is without one; NULL: that of the parameters */
bool emitter_init(emitter *e, const params *p, const char *name, const color_space *space,
                  GError **error);
/** @brief Reads `name` ("power", "illuminance"), which if given rescales such that the
 * emitter's Y times k_e is that number. */
bool emitter_set_total(emitter *e, const params *p, const char *name, float k_e,
                       GError **error);
spectrum emitter_eval(const emitter *e, const wavelengths *w);
void emitter_clear(emitter *e);

/* 380, 380 + 340/71, ... 720 nm: whole vectors of wavelengths. */
enum { EMISSION_SUM_N = 72 };

/** @brief A sum of emitters of RGB colours; {0} is none. */
typedef struct emission_sum {
    double values[EMISSION_SUM_N];
} emission_sum;

void emission_sum_add(emission_sum *sum, const color_space *space, const float rgb[3],
                      double weight);
/** @brief The sum as a spectrum, times scale. Owned by the caller. */
curve *emission_sum_curve(const emission_sum *sum, float scale);

/** @brief The world directions of a light's own axes, unit; a mirrored space is
 * left-handed. @return false with ERROR_INPUT if the transform stretches directions. */
bool light_axes(frame *axes, const transform *to_world, const params *p, GError **error);

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

/** @brief What leaves a point. */
light_emission light_leave_point(vec3 p, vec3 direction, float pdf_direction,
                                 spectrum flux);
/** @brief What arrives at ref from a point at p that sends `intensity` that way. @return
 *  false if that is nothing */
bool light_arrive_from_point(vec3 p, vec3 ref, spectrum intensity, light_sample *out);
/** @brief light_kind.pdf of lights that no direction drawn by others meets: 0. */
float light_delta_pdf(const void *self, vec3 ref, vec3 wi, const surface_hit *hit);
