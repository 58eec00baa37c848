/*
 * From linear light to what a screen shows: layer, exposure, tone curve, false colour.
 *
 * The curve is tabulated over the upper bits of a float, whose logarithmic spacing is as
 * fine as eight bits can show, so that a picture is converted by look-ups alone.
 */
#pragma once

#include <cairo.h>
#include <nephroid/nephroid.h>

typedef enum tone_curve {
    TONE_SRGB,     /**< as written to PNG: clipped at white */
    TONE_GAMMA,    /**< a plain power */
    TONE_REINHARD, /**< x / (1 + x), then sRGB: highlights are kept */
    TONE_FILMIC,   /**< a film's shoulder and toe, then sRGB */
    TONE_LINEAR,   /**< no encoding: for data */
    N_TONE_CURVES
} tone_curve;

/** @brief Names for people, NULL-terminated. */
extern const char *const tone_curve_names[];

typedef struct display_options {
    char layer[64]; /**< prefix of the channels, "" for the picture */
    float exposure; /**< stops */
    tone_curve curve;
    float gamma;       /**< of TONE_GAMMA */
    bool false_colour; /**< luminance as colour, logarithmic over eight stops */
    bool mark_bad;     /**< NaN magenta, infinite yellow */
} display_options;

/** @brief The usual ones. */
display_options display_defaults(void);

/** @brief Channel numbers of a layer: "" is the picture without noise where there is one,
 * "raw" then the picture as it was rendered; grey ones have the same three times. false:
 * the image has no such layer. */
bool display_channels(const NephImage *image, const char *layer, int channel[3]);

/** @brief Names of the layers of an image, the picture ("") first; NULL-terminated, owned
 * by the caller (g_strfreev). */
char **display_layers(const NephImage *image);

/** @brief The picture as an image surface, owned by the caller; NULL if the layer is
 * missing. Any thread. */
cairo_surface_t *display_surface(const NephImage *image, const display_options *options);

/** @brief The picture as the window shows it, for a file of eight bits: an image that is
 * written as those bytes. Owned by the caller; NULL with an error. Any thread. */
NephImage *display_image(const NephImage *image, const display_options *options,
                         GError **error);

/** @brief A colour, 0..1 each, for x in 0..1: dark blue to white. */
void display_false_colour(float x, float rgb[3]);

/** @brief Counts of luminance in stops: bin i of n covers [low, high) evenly; what is
 * outside goes to the ends. @return the largest count */
size_t display_histogram(const NephImage *image, const char *layer, float low, float high,
                         size_t n, size_t counts[3][256]);
