#include "format/lenient.h"

#include "params/build_context.h"

#include <string.h>

/* A material that can not be rendered, what is taken for it, and the parameters that
 * stay. */
typedef struct substitute {
    const char *kind, *becomes;
    const char *stays[8];
} substitute;

static const substitute substitutes[] = {
    {"hair", "diffuse", {"reflectance"}},
    {"subsurface",
     "coateddiffuse",
     {"reflectance", "eta", "roughness", "uroughness", "vroughness", "remaproughness"}},
    {"measured", "diffuse", {NULL}},
    {"fourier", "diffuse", {NULL}},
    {"kdsubsurface", "coateddiffuse", {"eta", "roughness", "remaproughness"}},
};

static const substitute *find_substitute(const char *kind)
{
    for (size_t i = 0; i < G_N_ELEMENTS(substitutes); i++) {
        if (strcmp(substitutes[i].kind, kind) == 0)
            return &substitutes[i];
    }
    return NULL;
}

static bool stays(const substitute *sub, const param *q)
{
    static const char *const of_all[] = {"displacement", "normalmap", NULL};
    for (size_t i = 0; i < G_N_ELEMENTS(sub->stays) && sub->stays[i]; i++) {
        if (strcmp(sub->stays[i], q->name) == 0)
            return true;
    }
    return g_strv_contains(of_all, q->name);
}

/* The parameters that stay; the names of the others are put into `dropped`. */
static params *keep_params(const substitute *sub, const params *p, GString *dropped,
                           GError **error)
{
    g_autoptr(params) kept = params_new_like(p);
    for (guint i = 0; i < p->list->len; i++) {
        param *q = p->list->pdata[i];
        bool is_type = strcmp(q->name, "type") == 0; /* of MakeNamedMaterial */
        q->used = true;
        if (stays(sub, q) && !params_add_copy(kept, q, error))
            return NULL;
        if (!stays(sub, q) && !is_type)
            g_string_append_printf(dropped, "%s '%s'", dropped->len ? "," : ", without",
                                   q->name);
    }
    return g_steal_pointer(&kept);
}

params *lenient_material(const build_context *context, const char **kind, const params *p,
                         GError **error)
{
    const substitute *sub = find_substitute(*kind);
    if (!sub)
        return NULL;
    if (!context->lenient) {
        error_at(error, p->place,
                 "material \"%s\" is not supported; --lenient takes \"%s\" for it", *kind,
                 sub->becomes);
        return NULL;
    }
    g_autoptr(GString) dropped = g_string_new(NULL);
    params *kept = keep_params(sub, p, dropped, error);
    build_is_lenient(context, p->place, "material \"%s\" becomes \"%s\"%s", *kind,
                     sub->becomes, dropped->str);
    *kind = sub->becomes;
    return kept;
}

/* ---- Media ---- */

bool lenient_medium(const build_context *context, const char *name, const char *kind,
                    const params *p, GError **error)
{
    static const char *const kinds[] = {"cloud",       "nanovdb",       "rgbgrid",
                                        "uniformgrid", "heterogeneous", NULL};
    if (!g_strv_contains(kinds, kind))
        return false;
    if (!context->lenient)
        error_at(error, p->place,
                 "medium \"%s\" is not supported, \"homogeneous\" is; --lenient takes "
                 "empty space for it",
                 kind);
    return build_is_lenient(context, p->place, "medium \"%s\" (%s) becomes empty space",
                            name, kind);
}

/* ---- Shapes ---- */

bool lenient_shape(const build_context *context, const char *kind, const params *p,
                   GError **error)
{
    static const char *const kinds[] = {"cone", "hyperboloid", "paraboloid", "nurbs",
                                        NULL};
    if (!g_strv_contains(kinds, kind))
        return false;
    if (!context->lenient)
        error_at(error, p->place,
                 "shape \"%s\" is not supported; --lenient leaves it out", kind);
    return build_is_lenient(context, p->place, "shape \"%s\" is left out", kind);
}

/* ---- Textures ---- */

params *lenient_texture(const build_context *context, const char **kind, bool is_spectrum,
                        const params *p, GError **error)
{
    if (strcmp(*kind, "ptex") != 0)
        return NULL;
    if (!context->lenient) {
        error_at(error, p->place,
                 "texture \"ptex\" is not supported; --lenient takes a constant of 0.5 "
                 "for it");
        return NULL;
    }
    const float half[] = {0.5f, 0.5f, 0.5f};
    params *kept = params_new_like(p);
    for (guint i = 0; i < p->list->len; i++)
        ((param *)p->list->pdata[i])->used = true;
    build_is_lenient(context, p->place, "texture \"ptex\" becomes a constant of 0.5");
    params_add_numbers(kept, p->place, is_spectrum ? PARAM_RGB : PARAM_FLOAT, "value",
                       half, is_spectrum ? 3 : 1, NULL);
    *kind = "constant";
    return kept;
}
