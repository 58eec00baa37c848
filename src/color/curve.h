/*
 * Curves: functions of wavelength, as scenes give them. A curve is an immutable value
 * that any thread may evaluate; textures and materials hold curves and evaluate them at a
 * pass' wavelengths.
 */
#pragma once

#include "base/error.h"
#include "color/wavelengths.h"

/** @brief What a spectrum in a scene file stands for: it decides how an RGB triple is
 * read. */
typedef enum curve_role {
    CURVE_ALBEDO,    /**< reflectance or transmittance in 0..1: RGB becomes a smooth curve
                          (Jakob & Hanika 2019) */
    CURVE_UNBOUNDED, /**< any non-negative quantity (eta, k): scale times a smooth curve
                      */
    CURVE_EMISSION,  /**< a light: RGB becomes scale * smooth curve * illuminant of the
                        space */
} curve_role;

/** @brief A named RGB space with its white point. */
typedef struct color_space color_space;

/** @brief sRGB; also "rec2020", "dci-p3", "aces2065-1". NULL if the name is unknown. */
const color_space *color_space_find(const char *name);
const color_space *color_space_srgb(void);
const char *color_space_name(const color_space *space);
/** @brief Linear RGB of the space from XYZ, and back; out may be in. */
void color_space_from_xyz(const color_space *space, const float xyz[3], float rgb[3]);
void color_space_to_xyz(const color_space *space, const float rgb[3], float xyz[3]);
/** @brief xy of red, green, blue and white, in that order (for EXR's chromaticities). */
void color_space_chromaticities(const color_space *space, float xy[8]);

/** @brief A function of wavelength. Opaque, immutable, reference counted. */
typedef struct curve curve;

/** @brief Points that a tabulated curve from a file or a parameter may have. */
enum { CURVE_MOST_POINTS = 100000 };

curve *curve_constant(float value);
/** @brief Piecewise linear through n >= 1 points (nm ascending), zero outside them like
 *  pbrt's PiecewiseLinearSpectrum; constant ends are the caller's choice of points.
 *  @return NULL with ERROR_INPUT if wavelengths do not ascend or a number is not finite.
 */
curve *curve_tabulated(const float *nm, const float *values, int n, GError **error);
/** @brief An RGB triple read by role in the given space.
 *  @return NULL with ERROR_INPUT if a component is negative, not finite, or > 1 for an
 * albedo. */
curve *curve_rgb(const color_space *space, const float rgb[3], curve_role role,
                 GError **error);
/** @brief Planck's law, normalised to a maximum of 1 over all wavelengths like pbrt. NULL
 *  unless kelvin is positive and finite. Below some 200 K nothing is visible: all zero.
 */
curve *curve_blackbody(float kelvin);
/** @brief A named spectrum as pbrt knows them: "metal-Au-eta", "metal-Au-k", "glass-BK7",
 *  "stdillum-D65", ... and ours (see the manual). NULL if unknown. */
curve *curve_named(const char *name);
/** @brief All names, NULL-terminated, static. */
const char *const *curve_names(void);

curve *curve_ref(const curve *c);
void curve_unref(curve *c); /**< NULL is allowed */
G_DEFINE_AUTOPTR_CLEANUP_FUNC(curve, curve_unref)

/** @brief The curve at the eight wavelengths. Thread-safe. */
spectrum curve_eval(const curve *c, const wavelengths *w);
/** @brief The curve at one wavelength in nm, 0 outside 360..830 (scalar; for tables and
 * tests). */
float curve_at(const curve *c, float nm);
/** @brief True if the curve has one value at all wavelengths: such a glass does not
 * disperse. */
bool curve_is_constant(const curve *c);
/** @brief Integral of ȳ c dλ over 360..830 nm: pbrt's SpectrumToPhotometric. For a
 *  CURVE_EMISSION RGB curve it is that of the space's illuminant alone, as pbrt has it.
 */
float curve_photometric(const curve *c);
/** @brief RGB texels to spectra: the three coefficients of the smooth curve of an albedo
 * triple in [0,1], by table look-up; pair with smooth_eval. Thread-safe. */
void smooth_from_rgb(const color_space *space, const float rgb[3], float coefficients[3]);
/** @brief The smooth (sigmoid of a quadratic) curve at the eight wavelengths, in [0, 1].
 */
spectrum smooth_eval(const float coefficients[3], const wavelengths *w);
/** @brief An RGB triple (components >= 0) by role at the eight wavelengths: what
 * curve_eval gives of curve_rgb, up to the table's accuracy, without making a curve. An
 * albedo's components above one count as one. Thread-safe. */
spectrum rgb_eval(const color_space *space, const float rgb[3], curve_role role,
                  const wavelengths *w);
