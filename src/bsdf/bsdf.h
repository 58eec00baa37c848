/*
 * Bidirectional scattering at one point.
 *
 * A material makes a bsdf at a hit; it is a value on the caller's stack. Directions of
 * the world calls are unit and point away from the surface. In TRANSPORT_RADIANCE, wo
 * goes to the eye and wi to where light comes from. In TRANSPORT_IMPORTANCE a photon is
 * scattered: wo goes back to where the photon came from and wi is where it goes on.
 *
 * Lobes have one of three classes, by what can be done with them:
 *   SPECULAR  a delta: only sampling finds it
 *   GLOSSY    so narrow that camera paths follow it by sampling (alpha < GLOSSY_ALPHA),
 *             or rough glass
 *   DIFFUSE   wide: photons are stored here and the radiance estimate is made with it
 * A material may have several: plastic is a specular or glossy coat over a diffuse base.
 *
 * Light that goes straight through a thin pane, unbent, has not been scattered: whoever
 * looks for light looks through, and paths go on as if the pane had not been there.
 *
 * Non-symmetry (Veach 1997, chapter 5): refraction scales radiance but not flux by
 * (η_o/η_i)², and with a shading normal photons are weighed by |wo·n||wi·n_geom| /
 * (|wo·n_geom||wi·n|). Both are in here, so callers multiply by `weight` and think no
 * more of it.
 */
#pragma once

#include "color/spectrum.h"
#include "color/wavelengths.h"
#include "medium/hit.h"

typedef enum lobe_flags {
    LOBE_SPECULAR = 1,
    LOBE_GLOSSY = 2,
    LOBE_DIFFUSE = 4,
    LOBE_REFLECTION = 8,
    LOBE_TRANSMISSION = 16,
    LOBE_ANY_SIDE = LOBE_REFLECTION | LOBE_TRANSMISSION,
    LOBE_FOLLOWED = LOBE_SPECULAR | LOBE_GLOSSY | LOBE_ANY_SIDE,
    LOBE_GATHERED = LOBE_DIFFUSE | LOBE_ANY_SIDE,
    LOBE_ALL = LOBE_SPECULAR | LOBE_GLOSSY | LOBE_DIFFUSE | LOBE_ANY_SIDE,
} lobe_flags;

/** Roughness (GGX alpha) below which a lobe is GLOSSY. */
#define GLOSSY_ALPHA 0.3f

typedef enum transport_mode { TRANSPORT_RADIANCE, TRANSPORT_IMPORTANCE } transport_mode;

enum { ALL_WAVELENGTHS = -1, BSDF_DATA_SIZE = 320 };

struct bsdf_ops;

/** @brief A BSDF at a point, for the wavelengths of a pass. */
typedef struct bsdf {
    const struct bsdf_ops *ops;
    frame shading; /**< n is the shading normal, s along dpdu */
    vec3 n_geom;
    unsigned lobes;  /**< the classes and sides present */
    int wavelength;  /**< the one wavelength a dispersed path keeps, or ALL_WAVELENGTHS */
    bool is_phase;   /**< a phase function: of a point in a medium, which has no surface;
                        it acts in world space, and its cosines are one */
    bool lambertian; /**< the DIFFUSE lobes are rho/pi, reflection only, both sides alike
                      */
    spectrum rho;    /**< if lambertian */
    _Alignas(32) unsigned char data[BSDF_DATA_SIZE]; /**< the material's own numbers */
} bsdf;

/** @brief One sampled direction. */
typedef struct bsdf_sample {
    vec3 wi;
    spectrum weight; /**< f |cos| / pdf with all corrections for the mode; multiply the
                        path's throughput by it. A dispersed sample has one wavelength,
                        times eight. */
    float pdf; /**< pdf_solid_angle of wi (all sampled lobes); probability if specular */
    unsigned
        lobe; /**< the class and side that was sampled, e.g. SPECULAR | TRANSMISSION */
    int wavelength; /**< the wavelength kept from here on, or ALL_WAVELENGTHS */
    float eta;      /**< η of the far side over this side if transmitted, else 1 */
    bool straight;  /**< through a thin pane: wi is -wo */
} bsdf_sample;

/** @brief f(wo, wi), sr⁻¹, of the lobes chosen by mask (classes and sides; specular ones
 * count as zero), without cosine; in IMPORTANCE with the adjoint corrections such that
 * the weight of a scattered photon is f |wi·n| / pdf. Where geometric and shading normal
 * disagree about the side, the geometric one tells it (see bsdf.c); wide lobes are then
 * not lit. */
spectrum bsdf_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode);

/** @brief pdf_solid_angle with which bsdf_sample picks wi given the same mask, specular
 * lobes apart (they can not be hit), but with the probability of choosing them left out
 * of it. */
float bsdf_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode);

/** @brief Samples wi from the lobes in mask.
 *  @param u_lobe,u uniform in [0,1); @return false: absorbed or nothing in mask. */
bool bsdf_sample_direction(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                           transport_mode mode, bsdf_sample *out);

/** @brief Share of light that goes straight through, to -wo, unbent; 0 but of thin panes,
 * of which it is what sampling that direction would weigh times its probability. */
spectrum bsdf_straight(const bsdf *b, vec3 wo);

/** @brief True if light may go by a DIFFUSE and by a GLOSSY lobe from one direction to
 * another. */
static inline bool bsdf_has_both(const bsdf *b)
{
    return (b->lobes & LOBE_DIFFUSE) && (b->lobes & LOBE_GLOSSY);
}

/** @brief Chooses the class of lobes by which light goes from wi to wo, in proportion to
 * what each sends on: the one that drew a direction says little of it, as another may
 * send more there. Light of a class is then that of its lobes alone.
 *  @param u uniform in [0,1)
 *  @param f gets bsdf_eval of that class over the probability of choosing it
 *  @return LOBE_DIFFUSE or LOBE_GLOSSY; 0 if neither sends any */
unsigned bsdf_choose_class(const bsdf *b, vec3 wo, vec3 wi, transport_mode mode, float u,
                           spectrum *f);

/** @brief Does so for a direction that was drawn of all lobes and is not specular: its
 * weight and lobe become those of the class. */
void bsdf_settle_class(const bsdf *b, vec3 wo, transport_mode mode, float u,
                       bsdf_sample *drawn);

/** @brief |cos| between direction wi and the shading normal, by which light from there
 * counts. */
static inline float bsdf_cosine(const bsdf *b, vec3 wi)
{
    return b->is_phase ? 1.0f : fabsf(dot3(wi, b->shading.n));
}

/** @brief Share of the light going out to wo under uniform white illumination, lobes in
 * mask: exact where cheap, else close (used for Whitted splitting, the albedo layer and
 *  irradiance-based shortcuts, never for unbiased weights). */
spectrum bsdf_albedo(const bsdf *b, vec3 wo, unsigned lobes);

/** @brief Henyey and Greenstein's phase function ("Diffuse radiation in the Galaxy",
 * 1941) of light that a medium scatters: a whole bsdf, of which nothing need be set.
 * @param g mean cosine, -1 < g < 1 */
void bsdf_make_phase(bsdf *b, float g, int wavelength);

/* ---- For materials: the same in the local frame, n = +z ---- */

/** @brief What a material's scattering must do. Local frame, sides decided by the sign of
 * z. weight of sample = f |wi.z| / pdf; adjoint factors for shading normals are added
 * outside. */
typedef struct bsdf_ops {
    const char *name;
    spectrum (*eval)(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                     transport_mode mode);
    float (*pdf)(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode);
    bool (*sample)(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                   transport_mode mode, bsdf_sample *out);
    spectrum (*albedo)(const bsdf *b, vec3 wo, unsigned lobes);
    spectrum (*straight)(const bsdf *b, vec3 wo); /**< NULL: nothing goes */
} bsdf_ops;
