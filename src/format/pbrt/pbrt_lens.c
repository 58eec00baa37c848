/*
 * pbrt's realistic camera, as a perspective one: the field of view is that of the lens
 * system's focal length, by paraxial rays through its file, depth of field that of its
 * aperture, and the film gets as much light as behind such a lens. What only the lens
 * itself shows (distortion, vignetting) is lost, and said so.
 *
 * A file has four numbers an element, from the scene to the film, in mm: the radius of
 * curvature (0: the aperture stop), the way to the next, the index behind it, and the
 * diameter.
 */
#include "format/pbrt/pbrt_parser.h"

#include "format/given.h"
#include "format/spectrum_file.h"

#include <math.h>
#include <string.h>

enum { PER_ELEMENT = 4 };

/* pbrt's; the shape of the aperture is lost. */
#define PARAMETERS                                                                       \
    "lensfile aperturediameter focusdistance aperture simpleweighting shutteropen "      \
    "shutterclose"

/* Where a ray parallel to the axis would cross it, seen from the principal plane, mm; not
 * positive: nowhere. */
static double focal_length(const float *v, size_t n_elements)
{
    double height = 1.0, slope = 0.0, index = 1.0;
    for (size_t i = 0; i < n_elements; i++, v += PER_ELEMENT) {
        double radius = (double)v[0], behind = v[2] > 0.0f ? (double)v[2] : 1.0;
        double power = fabs(radius) > 0.0 ? (behind - index) / radius : 0.0;
        slope = (index * slope - height * power) / behind;
        index = behind;
        if (i + 1 < n_elements)
            height += slope * (double)v[1];
    }
    return slope < 0.0 ? -1.0 / slope : 0.0;
}

static double number_of(const params *p, const char *name, double fallback)
{
    float value = (float)fallback;
    params_float(p, name, &value, NULL);
    return (double)value;
}

static int size_of(const params *p, const char *name, int fallback)
{
    int value = fallback;
    if (p)
        params_integer(p, name, &value, NULL);
    return MAX(value, 1);
}

/* Degrees, of the shorter side. */
static double field_of_view(const params *film, double focal)
{
    double diagonal = film ? number_of(film, "diagonal", 35.0) : 35.0;
    double x = size_of(film, "xresolution", 1280), y = size_of(film, "yresolution", 720);
    double shorter = diagonal * fmin(x, y) / hypot(x, y);
    return 2.0 * atan(0.5 * shorter / focal) * 180.0 / G_PI;
}

static params *perspective_of(const params *p, double fov, double aperture)
{
    static const char *const kept[] = {"shutteropen", "shutterclose"};
    params *out = params_new_like(p);
    give_float(out, "fov", fov);
    give_float(out, "lensradius", 0.5e-3 * aperture);
    give_float(out, "focaldistance", number_of(p, "focusdistance", 10.0));
    for (size_t i = 0; i < G_N_ELEMENTS(kept); i++)
        if (params_has(p, kept[i]))
            params_add_copy(out, params_find(p, kept[i]), NULL);
    return out;
}

/* Behind the lens the film gets the share that its aperture lets through. */
static void dim_film(pbrt_parser *parser, double share)
{
    params *film = parser->film.p;
    double iso = film ? number_of(film, "iso", 100.0) : 100.0;
    if (!film)
        return;
    params_remove(film, "iso");
    give_float(film, "iso", iso * share);
}

static void take_lens(pbrt_parser *parser, const GArray *lens)
{
    pending *c = &parser->camera;
    double focal =
        focal_length((const float *)(const void *)lens->data, lens->len / PER_ELEMENT);
    double aperture = number_of(c->p, "aperturediameter", 1.0);
    if (lens->len % PER_ELEMENT || !(focal > 0.0) || !(aperture > 0.0)) {
        pbrt_error(parser, c->place,
                   "expected a lens that focuses, of four numbers an element, and an "
                   "aperture, found another");
        return;
    }
    double fov = field_of_view(parser->film.p, focal);
    params *perspective = perspective_of(c->p, fov, aperture);
    pbrt_warning(
        parser, c->place,
        "camera \"realistic\" becomes \"perspective\" with a field of view of %.3g "
        "degrees, which its lens of %.3g mm has",
        fov, focal);
    params_free(c->p);
    c->p = perspective;
    g_free(c->kind);
    c->kind = g_strdup("perspective");
    if (!parser->is_v3) /* whose lenses are bright by default */
        dim_film(parser, 0.25 * G_PI * aperture * aperture / (focal * focal));
}

void pbrt_flatten_lens(pbrt_parser *parser)
{
    pending *c = &parser->camera;
    GError *error = NULL;
    g_autofree char *path = NULL;
    if (!c->kind || strcmp(c->kind, "realistic") != 0)
        return;
    if (params_known(c->p, "camera \"realistic\"", PARAMETERS, NULL, &error) &&
        params_path(c->p, "lensfile", &path, &error) && !path)
        error_at(&error, c->place, "expected \"string lensfile\", found none");
    if (path)
        scene_sources_add(parser->builder->build.sources, path);
    g_autoptr(GArray) lens =
        error ? NULL
              : spectrum_file_read(path, params_find(c->p, "lensfile")->place, &error);
    if (lens)
        take_lens(parser, lens);
    else
        pbrt_report(parser, error);
}
