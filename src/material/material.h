/*
 * Materials: what makes a bsdf at a hit. One file and one row of the kinds table each.
 */
#pragma once

#include "bsdf/bsdf.h"
#include "material/material_bump.h"
#include "params/params.h"
#include "texture/texture.h"

/** @brief How bsdfs are to be made, by setting. */
typedef struct bsdf_options {
    bool deterministic; /**< multiple_samples off: rough is smooth, glass only refracts
                           (or reflects totally), coats are dropped */
    bool metal_is_followed; /**< metal's lobes are GLOSSY however rough */
    int least_walks;        /**< averaged where light walks at random between layers */
} bsdf_options;

typedef struct material_kind {
    const char *name;       /**< pbrt's, e.g. "coateddiffuse" */
    const char *parameters; /**< those it reads, with spaces between */
    void *(*create)(const build_context *context, const params *p, GError **error);
    void (*free)(void *self);
    /** Fills ops, lobes, lambertian, rho, data; the frame, n_geom and wavelength are
     * filled already. */
    void (*make_bsdf)(const void *self, const surface_hit *hit, const wavelengths *w,
                      const bsdf_options *options, bsdf *out);
    /** Lobe classes and sides that may occur anywhere on it: SPECULAR or GLOSSY ones cast
     *  caustics. */
    unsigned (*possible_lobes)(const void *self);
    /** True if metal reflects at some place of it. May be NULL: nowhere. */
    bool (*is_metal)(const void *self);
    /** What fills a solid made of it; NULL: none. May be NULL. */
    const struct medium *(*interior)(const void *self);
    /** True if its surfaces bound a body that refracts. May be NULL: they do not. */
    bool (*encloses)(const void *self);
    /** True if light may go straight through at some place (bsdf_straight). May be NULL:
     * nowhere. */
    bool (*is_pane)(const void *self);
} material_kind;

typedef struct material {
    const material_kind *kind;
    void *self;
    unsigned lobes; /**< classes and sides that may occur anywhere on it */
    bump *bump; /**< what bends its normals; NULL: nothing */
    char *name; /**< from MakeNamedMaterial; NULL if none */
} material;

/** @brief The parameters that every material has. */
#define MATERIAL_PARAMETERS "normalmap normalscale displacement"

/** @brief Kind number i of the table; NULL behind the last. */
const material_kind *material_kind_at(size_t i);
material *material_new(const build_context *context, const char *kind, const params *p,
                       GError **error);
void material_free(material *m);

/** @brief The bsdf of a material at a hit.
 *  @param wavelength ALL_WAVELENGTHS, or the wavelength a dispersed path has kept */
void material_bsdf(const material *m, const surface_hit *hit, const wavelengths *w,
                   int wavelength, const bsdf_options *options, bsdf *out);

/** @brief True if its surfaces bound a body that refracts. */
bool material_encloses(const material *m);
/** @brief True if light may go straight through it somewhere (bsdf_straight). */
bool material_is_pane(const material *m);
/** @brief What fills a solid made of it; NULL: none. */
const struct medium *material_interior(const material *m);

/** @brief True of metal, bare or lacquered. */
bool material_is_conductor(const material *m);

/** @brief True if light may leave a surface of it by a specular or glossy lobe. */
bool material_casts_caustics(const material *m);
