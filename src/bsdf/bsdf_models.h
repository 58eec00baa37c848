/*
 * The scattering models, apart from the materials that read their parameters.
 *
 * Each function fills ops, lobes, lambertian, rho and data of a bsdf whose frame, n_geom
 * and wavelength are set already.
 */
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/coat.h"
#include "bsdf/microfacet.h"

/** @brief True if the lobe (one class, one side) is among those of a mask. */
static inline bool lobe_wanted(unsigned mask, unsigned lobe)
{
    unsigned both = mask & lobe;
    return (both & LOBE_ANY_SIDE) && (both & ~(unsigned)LOBE_ANY_SIDE);
}

/** @brief The class of a lobe of this roughness. */
static inline unsigned ggx_class(ggx g)
{
    if (ggx_is_smooth(g))
        return LOBE_SPECULAR;
    return maxf(g.alpha_x, g.alpha_y) < GLOSSY_ALPHA ? LOBE_GLOSSY : LOBE_DIFFUSE;
}

/** @brief The same lobe as one that is followed however wide it is. */
static inline unsigned lobe_followed(unsigned lobe)
{
    return lobe & LOBE_DIFFUSE ? (lobe & ~(unsigned)LOBE_DIFFUSE) | LOBE_GLOSSY : lobe;
}

/** @brief The class of a lobe that passes light on: however rough, it is to be followed.
 * What comes through turns with the facets' slope, so that on glass that bends, light
 * gathered a little way off points elsewhere, and an estimate of it is far too bright. */
static inline unsigned ggx_glass_class(ggx g)
{
    return ggx_is_smooth(g) ? LOBE_SPECULAR : LOBE_GLOSSY;
}

/** @brief The value that decides in random choices: of the wavelength kept, or the mean.
 */
static inline float wavelength_mean(const bsdf *b, spectrum s)
{
    return b->wavelength == ALL_WAVELENGTHS ? spectrum_mean(s) : s[b->wavelength];
}

/** @brief w mirrored to z >= 0 if `flip`. */
static inline vec3 flip_z(vec3 w, bool flip)
{
    return flip ? vec3_make(w[0], w[1], -w[2]) : w;
}

/** @brief eval and pdf of models with specular lobes only: zero. */
spectrum bsdf_delta_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                         transport_mode mode);
float bsdf_delta_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                     transport_mode mode);

/** @brief Lambert's law, alike on both sides. @param rho reflectance in 0..1 */
void bsdf_make_diffuse(bsdf *b, spectrum rho);

/** @brief Lambert's law on both sides. @param r,t shares sent back and let through, in
 * 0..1; where they exceed one together they are brought down to it */
void bsdf_make_diffuse_transmission(bsdf *b, spectrum r, spectrum t);

/** @brief A metal, smooth or rough, alike on both sides. */
void bsdf_make_conductor(bsdf *b, spectrum eta, spectrum k, ggx roughness);

/** @brief A boundary between dielectrics, smooth or rough.
 *  @param eta index below the surface over that above
 *  @param disperses eta differs between wavelengths: a refracted ray keeps one of them */
void bsdf_make_dielectric(bsdf *b, spectrum eta, bool disperses, ggx roughness);

/** @brief The same, with the light that passes multiplied by a tint in 0..1. */
void bsdf_make_tinted_dielectric(bsdf *b, spectrum eta, bool disperses, ggx roughness,
                                 spectrum tint);

/** @brief A smooth boundary that only refracts, without loss, or reflects totally: the
 * one deterministic path of Whitted's tracer without splitting. */
void bsdf_make_refractor(bsdf *b, spectrum eta, bool disperses);

/** @brief A thin plate: reflections between its two faces summed up, direction kept. */
void bsdf_make_thin_dielectric(bsdf *b, spectrum eta);

/** @brief A thin plate that lets everything pass. */
void bsdf_make_clear(bsdf *b);

/** @brief A diffuse base under a dielectric coat that may absorb.
 *  @param rho albedo of the base
 *  @param eta index of the coat over that outside, within the table's range
 *  @param alpha roughness of the coat, in all directions
 *  @param table of the coat, borrowed
 *  @param bounces off the base, at most, before light is given up */
void bsdf_make_coated(bsdf *b, spectrum rho, spectrum eta, float alpha,
                      const coat_table *table, int bounces);

/** @brief A metal or a diffuse base under a rough or smooth coat, in which light may be
 * scattered by particles. Thickness is optical: the path straight through the coat over
 * the mean free path. */
typedef struct coat_layers {
    bool is_metal;
    bool is_followed; /**< what its faces reflect is GLOSSY however rough they are */
    spectrum metal_eta, metal_k; /**< of the metal, over vacuum */
    spectrum rho;                /**< of the diffuse base, 0..1 */
    spectrum albedo;             /**< of the particles, 0..1; 0: they only absorb */
    float eta;                   /**< of the coat over that outside */
    float thickness, g;          /**< g: Henyey-Greenstein's mean cosine, -1..1 */
    ggx coat, base;              /**< base: of the metal */
    int max_depth;               /**< events of a walk within the coat, at most */
    int n_walks;                 /**< over which a value is averaged */
    uint32_t seed;               /**< of the walks, one of its own each pass */
} coat_layers;

void bsdf_make_layered(bsdf *b, const coat_layers *from);

/** @brief Normalised Blinn-Phong; where reflectance + specular > 1 the former is cut. */
void bsdf_make_phong(bsdf *b, spectrum reflectance, spectrum specular, float exponent);
