/*
 * Kinds that pbrt-v3 does not know: of programs made from it, or misspelt. It warns of
 * them and goes on, and so do we.
 */
#include "format/pbrt/pbrt_parser.h"

#include "light/light.h"
#include "material/material.h"
#include "texture/texture.h"

#include <string.h>

static const char *light_name(size_t i)
{
    const light_kind *kind = light_kind_at(i);
    return kind ? kind->name : NULL;
}

static const char *material_name(size_t i)
{
    const material_kind *kind = material_kind_at(i);
    return kind ? kind->name : NULL;
}

static const char *texture_name(size_t i)
{
    const texture_kind *kind = texture_kind_at(i);
    return kind ? kind->name : NULL;
}

typedef struct known_kinds {
    const char *what, *instead;
    const char *(*ours)(size_t i);
    const char *more[18]; /* of pbrt-v3, and of pbrt-v4 what is not ours */
} known_kinds;

static const known_kinds known[N_V3_TARGETS] = {
    [V3_MATERIAL] = {"material",
                     "\"matte\" is taken for it",
                     material_name,
                     {"", "none", "interface", "matte", "plastic", "translucent", "glass",
                      "mirror", "hair", "disney", "metal", "substrate", "uber",
                      "subsurface", "kdsubsurface", "fourier", "measured"}},
    [V3_TEXTURE] = {"texture", "it is left out", texture_name, {"uv", "ptex"}},
    [V3_MEDIUM] = {"medium",
                   "it is left out",
                   medium_kind_name,
                   {"heterogeneous", "uniformgrid", "rgbgrid", "nanovdb", "cloud"}},
    [V3_LIGHT] = {"light", "it is left out", light_name, {"exinfinite"}},
    [V3_AREA_LIGHT] = {"area light",
                       "its shapes do not shine",
                       NULL,
                       {"area", "diffuse"}},
    [V3_SHAPE] = {"shape",
                  "it is left out",
                  shape_kind_name,
                  {"plymesh", "cone", "hyperboloid", "paraboloid", "nurbs",
                   "heightfield"}},
};

static bool is_among(const known_kinds *kinds, const char *kind)
{
    for (size_t i = 0; kinds->ours && kinds->ours(i); i++)
        if (strcmp(kinds->ours(i), kind) == 0)
            return true;
    for (size_t i = 0; i < G_N_ELEMENTS(kinds->more) && kinds->more[i]; i++)
        if (strcmp(kinds->more[i], kind) == 0)
            return true;
    return false;
}

bool pbrt_v3_knows(const pbrt_parser *parser, pbrt_v3_target target, const char *kind,
                   source_place at)
{
    const known_kinds *kinds = &known[target];
    bool found = is_among(kinds, kind);
    if (!found)
        pbrt_warning(parser, at, "%s \"%s\" is unknown: %s", kinds->what, kind,
                     kinds->instead);
    return found;
}
