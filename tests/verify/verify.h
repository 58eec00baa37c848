/*
 * The verify suite: whole renders against what must hold, with the statistics to tell an
 * error from noise.
 *
 *   scene, settings ─► verify_render ─► trial: block by block, group of passes by group
 *                                         └─► verify_compare(a, b) ─► mean, worst block
 *
 * Passes are independent but for their wavelengths, which are the same for all algorithms
 * of one seed. So trials of the same number of passes are compared pass by pass, and what
 * wavelengths do to both is not taken for noise.
 *
 * Blocks of pixels are held to what a radius may blur, pixels to noise alone: where
 * nothing blurs (path tracing, connections), or no further than a small part of a pixel.
 * The latter needs a `radius` that is given and then photons enough, so that a pixel's
 * mean is known; with radii that the renderer chooses, some pixels wide, that can not be
 * asked.
 *
 * A pixel's passes are few and their distribution has a long tail upward, of which a mean
 * and a variance know too little: in 32 groups that met no bright path both are small. So
 * Student's t is taken with its skewness (Johnson, "Modified t Tests and Confidence
 * Intervals for Asymmetrical Populations", 1978).
 *
 * The short form runs with all tests. NEPHROID_VERIFY=long takes more samples and allows
 * less.
 */
#pragma once

#include "render_with.h"

enum { VERIFY_GROUPS = 32, VERIFY_BLOCKS = 64, VERIFY_PIXELS = 1024 };

/** @brief A render as its passes told it: luminance of what is reflected (all but the
 * lamps as the camera sees them, whose edges make a noise of their own). */
typedef struct trial {
    double value[VERIFY_GROUPS][VERIFY_BLOCKS]; /**< mean over a block of pixels, by
                                                   groups of passes */
    double mean[VERIFY_BLOCKS], total;          /**< of all passes; of the picture */
    double error;                               /**< standard error of total */
    size_t n_pixels;                            /**< at most VERIFY_PIXELS */
    float pixel[VERIFY_GROUPS][VERIFY_PIXELS];  /**< as value, pixel by pixel */
} trial;

/** @brief What the comparison of two trials found. */
typedef struct agreement {
    double off;   /**< total of a over that of b, less one */
    double error; /**< standard error of that */
    double z;     /**< of the worst block, as a normal deviate, beyond the bias allowed */
    double limit; /**< of |z|, so that noise alone passes it once in 10⁶ comparisons */
    double pixel_z, pixel_limit; /**< of the worst pixel, without any bias */
} agreement;

/** @brief True if NEPHROID_VERIFY is "long". */
bool verify_is_long(void);

/** @brief The first in the short form, the second in the long one. */
#define VERIFY_SHORT_LONG(a, b) (verify_is_long() ? (b) : (a))

/** @brief What is rendered, by settings in words. The image is cut into 8 x 8 blocks, so
 * its sides are multiples of 8 pixels. */
typedef struct subject {
    const view *view;
    const char *words;
    bool lamps; /**< with the lamps as the camera sees them */
    bool flip;  /**< left for right */
} subject;

/** @brief Renders `passes` passes, a multiple of VERIFY_GROUPS. */
trial verify_render(const subject *of, int passes);

/**
 * @brief Compares a with b, group by group: Student's t for each block, made a normal
 * deviate.
 * @param bias relative difference of a block that is allowed besides noise: what a radius
 * blurs; 0 where none is
 */
agreement verify_compare(const trial *a, const trial *b, double bias);

enum { VERIFY_LEVELS = 4 };

/** @brief What others are held to: a subject, whose renders are kept by their numbers of
 * passes (times 4 a level), or a number that every block must be. Clear at the end. */
typedef struct yardstick {
    subject of;
    double expected;              /**< if there is no scene */
    trial *levels[VERIFY_LEVELS]; /**< made when asked for */
} yardstick;

void yardstick_clear(yardstick *is);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(yardstick, yardstick_clear)

/** @brief What may differ. */
typedef struct allowance {
    double total; /**< relative */
    double block; /**< bias of verify_compare */
    bool pixels;  /**< each pixel too must be right, to noise */
} allowance;

/**
 * @brief Renders and compares. Fails if totals differ by more than is allowed and noise,
 * or some block (or pixel) is beyond its limit, or noise is so much that this says
 * little: a total not known to three times what is allowed. The long form takes four
 * times as many passes until it is known to half of that.
 * @param passes of the short form
 */
void verify_agree(const char *name, const subject *of, yardstick *is, int passes,
                  allowance allowed);

/** @brief The normal deviate whose |z| one of n independent ones passes with probability
 * alpha (Šidák 1967). */
double verify_sidak(double alpha, size_t n);

/** @brief The normal deviate as unlikely as Student's t (Wallace 1959). */
double verify_normal_of_t(double t, double freedom);

/** @brief Slope of the least-squares line through (log x, log y). */
double verify_log_slope(const double *x, const double *y, size_t n);
