/*
 * The film directive: pbrt's "rgb" and "gbuffer" films. Every picture has layers of
 * albedo, shading normal, depth and variance; a gbuffer adds pbrt's own (gbuffer.h in
 * src/render), in the camera's space unless it says "world". A "spectral" film is an rgb
 * one, with a note.
 *
 * The sensors of cameras see as the cie1931 observer does, with a note: pbrt, too, brings
 * what they measure to its colours, by the matrix that does so best, and as there the
 * daylight of 6500 K is white to them. "diagonal" acts on realistic cameras only, in pbrt
 * too, and those are refused by the camera; "savefp16" asks for less than the float
 * images that are written.
 */
#include "scene/scene_film.h"
#include "color/balance.h"

#include <string.h>

enum { SIDE_MAX = 65536 };

static bool read_size(const params *p, const char *name, int *out, GError **error)
{
    if (!params_integer(p, name, out, error))
        return false;
    if (*out >= 1 && *out <= SIDE_MAX)
        return true;
    error_at(error, params_find(p, name)->place, "%s must be 1..%d pixels, found %d",
             name, SIDE_MAX, *out);
    return false;
}

static bool read_number_above_zero(const params *p, const char *name, float *out,
                                   GError **error)
{
    if (!params_float(p, name, out, error))
        return false;
    if (*out > 0.0f)
        return true;
    error_at(error, params_find(p, name)->place, "%s must be positive, found %g", name,
             (double)*out);
    return false;
}

/* The first is the observer that colours are defined by. */
static const char *const sensors[] = {"cie1931",
                                      "canon_eos_100d",
                                      "canon_eos_1dx_mkii",
                                      "canon_eos_200d",
                                      "canon_eos_200d_mkii",
                                      "canon_eos_5d",
                                      "canon_eos_5d_mkii",
                                      "canon_eos_5d_mkiii",
                                      "canon_eos_5d_mkiv",
                                      "canon_eos_5ds",
                                      "canon_eos_m",
                                      "hasselblad_l1d_20c",
                                      "nikon_d810",
                                      "nikon_d850",
                                      "sony_ilce_6400",
                                      "sony_ilce_7m3",
                                      "sony_ilce_7rm3",
                                      "sony_ilce_9",
                                      NULL};

/* Daylight that is white to a camera's sensor if nothing is said. */
#define SENSOR_WHITE 6500.0f

static bool read_white(const params *p, film_settings *film, int sensor, GError **error)
{
    if (!params_float(p, "whitebalance", &film->kelvin, error))
        return false;
    if (sensor > 0 && !(fabsf(film->kelvin) > 0.0f))
        film->kelvin = SENSOR_WHITE;
    if (!(fabsf(film->kelvin) > 0.0f) ||
        (film->kelvin >= WHITE_COLDEST && film->kelvin <= DAYLIGHT_HOTTEST))
        return true;
    error_at(error, params_find(p, "whitebalance")->place,
             "\"whitebalance\" must be 0 or the temperature of a white, %g to %g "
             "kelvin, found %g",
             (double)WHITE_COLDEST, (double)DAYLIGHT_HOTTEST, (double)film->kelvin);
    return false;
}

static bool read_sensor(const params *p, film_settings *film, GError **error)
{
    int sensor = 0;
    if (!params_choice(p, "sensor", sensors, &sensor, error) ||
        !read_white(p, film, sensor, error))
        return false;
    return !params_has(p, "maxcomponentvalue") ||
           read_number_above_zero(p, "maxcomponentvalue", &film->most, error);
}

/* What a gbuffer has and other films have not: the space of its layers, and only one kind
 * of file that can hold them. */
static bool read_gbuffer(const params *p, film_settings *film, GError **error)
{
    static const char *const spaces[] = {"camera", "world", NULL};
    int space = 0;
    if (!params_choice(p, "coordinatesystem", spaces, &space, error))
        return false;
    film->gbuffer = true;
    film->in_camera = space == 0;
    if (!film->filename || g_str_has_suffix(film->filename, ".exr"))
        return true;
    error_at(error, params_find(p, "filename")->place,
             "film \"gbuffer\": only an .exr file can hold its layers, found '%s'",
             film->filename);
    return false;
}

/* The buckets that nothing is put into. */
static bool read_spectral(const params *p, film_settings *film, GError **error)
{
    int n = 16;
    float from = LAMBDA_MIN, to = LAMBDA_MAX;
    (void)film;
    return params_integer(p, "nbuckets", &n, error) &&
           params_float(p, "lambdamin", &from, error) &&
           params_float(p, "lambdamax", &to, error);
}

/* Half a pixel inside, so that ceil(crop * size) gives the bounds back. */
static bool read_pixel_bounds(const param *given, film_settings *film, GError **error)
{
    const int size[2] = {film->width, film->height};
    bool fits = given->type == PARAM_INTEGER && given->n == 4;
    for (int i = 0; i < 2 && fits; i++) {
        int low = MAX(given->integers[2 * i], 0);
        int high = MIN(given->integers[2 * i + 1], size[i]);
        fits = low < high;
        film->crop[2 * i] = maxf(0.0f, ((float)low - 0.5f) / (float)size[i]);
        film->crop[2 * i + 1] = ((float)high - 0.5f) / (float)size[i];
    }
    if (!fits)
        error_at(error, given->place,
                 "\"pixelbounds\" needs four integers x0 x1 y0 y1 with pixels of the "
                 "%d x %d between them",
                 size[0], size[1]);
    return fits;
}

static bool read_crop_window(const param *given, film_settings *film, GError **error)
{
    bool fits = given->type == PARAM_FLOAT && given->n == 4;
    for (int i = 0; i < 2 && fits; i++) {
        float a = clampf(given->numbers[2 * i], 0.0f, 1.0f);
        float b = clampf(given->numbers[2 * i + 1], 0.0f, 1.0f);
        fits = fabsf(b - a) > 0.0f;
        film->crop[2 * i] = minf(a, b);
        film->crop[2 * i + 1] = maxf(a, b);
    }
    if (!fits)
        error_at(error, given->place,
                 "\"cropwindow\" needs four numbers x0 x1 y0 y1 with a part of 0..1 "
                 "between them");
    return fits;
}

/* Of both the window counts, and what lies beyond the film is cut off, as in pbrt. */
static bool read_crop(const params *p, film_settings *film, GError **error)
{
    const param *window = params_find(p, "cropwindow");
    const param *bounds = params_find(p, "pixelbounds");
    if (window)
        return read_crop_window(window, film, error);
    return !bounds || read_pixel_bounds(bounds, film, error);
}

static bool read_film(const params *p, film_settings *film, GError **error)
{
    float diagonal = 35.0f;
    bool save_half = false;
    const char *filename = NULL;
    if (!read_size(p, "xresolution", &film->width, error) ||
        !read_size(p, "yresolution", &film->height, error) ||
        !read_crop(p, film, error) || !read_sensor(p, film, error) ||
        !read_number_above_zero(p, "iso", &film->iso, error) ||
        !read_number_above_zero(p, "diagonal", &diagonal, error) ||
        !params_bool(p, "savefp16", &save_half, error) ||
        !params_string(p, "filename", &filename, error))
        return false;
    film->space = p->space ? p->space : color_space_srgb();
    film->filename = g_strdup(filename);
    return true;
}

film_settings film_default(void)
{
    return (film_settings){.width = 1280,
                           .height = 720,
                           .iso = 100.0f,
                           .crop = {0.0f, 1.0f, 0.0f, 1.0f},
                           .space = color_space_srgb()};
}

#define ALL_FILMS                                                                        \
    "xresolution yresolution cropwindow pixelbounds filename iso sensor whitebalance "   \
    "maxcomponentvalue"
#define IDLE "diagonal savefp16"

static const struct film_kind {
    const char *name, *parameters, *idle;
    bool (*read)(const params *p, film_settings *film, GError **error); /* its own */
} kinds[] = {
    {"rgb", ALL_FILMS, IDLE, NULL},
    {"gbuffer", ALL_FILMS " coordinatesystem", IDLE, read_gbuffer},
    {"spectral", ALL_FILMS, IDLE " nbuckets lambdamin lambdamax", read_spectral},
};

const char *film_kind_at(size_t i, const char **parameters, const char **idle)
{
    if (i >= G_N_ELEMENTS(kinds))
        return NULL;
    *parameters = kinds[i].parameters;
    *idle = kinds[i].idle;
    return kinds[i].name;
}

static const struct film_kind *find_kind(const char *name, const params *p,
                                         GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++)
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    error_at(error, p->place,
             "film \"%s\" is not supported; known are rgb, gbuffer and spectral", name);
    return NULL;
}

static void note_what_differs(const char *kind, const params *p, const log_sink *log)
{
    const param *sensor = params_find(p, "sensor");
    if (strcmp(kind, "spectral") == 0)
        log_at(log, LOG_NOTE, p->place,
               "film \"spectral\" becomes \"rgb\": the picture has colours "
               "and no spectra");
    if (params_has(p, "cropwindow") && params_has(p, "pixelbounds"))
        log_at(log, LOG_NOTE, params_find(p, "pixelbounds")->place,
               "\"cropwindow\" counts, and \"pixelbounds\" beside it does not");
    if (sensor && strcmp(sensor->strings[0], sensors[0]) != 0)
        log_at(log, LOG_NOTE, sensor->place,
               "sensor \"%s\" sees as \"%s\" does, in the colours of the "
               "film",
               sensor->strings[0], sensors[0]);
}

bool film_init(film_settings *film, const char *name, const params *p,
               const log_sink *log, GError **error)
{
    const struct film_kind *kind = find_kind(name, p, error);
    film_settings read = film_default();
    g_autofree char *what = g_strdup_printf("film \"%s\"", name);
    if (kind && params_known(p, what, kind->parameters, kind->idle, error) &&
        read_film(p, &read, error) && (!kind->read || kind->read(p, &read, error)) &&
        params_all_used(p, what, error)) {
        note_what_differs(name, p, log);
        *film = read;
        return true;
    }
    g_free(read.filename);
    return false;
}
