/* Making materials by kind, and their bsdfs at a hit. */
#include "material/material_kinds.h"

#include "params/kinds.h"

static const material_kind *const kinds[] = {
#define MATERIAL(kind, file) &material_##kind,
#include "material/material.def"
#undef MATERIAL
};

const material_kind *material_kind_at(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i] : NULL;
}

static const char *name_of(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i]->name : NULL;
}

material *material_new(const build_context *context, const char *kind, const params *p,
                       GError **error)
{
    int i = kind_find(name_of, "a material", kind, p->place, error);
    if (i < 0)
        return NULL;
    const material_kind *k = kinds[i];
    g_autofree char *what = g_strdup_printf("material '%s'", kind);
    if (!params_known(p, what, k->parameters, MATERIAL_PARAMETERS, error))
        return NULL;
    void *self = k->create(context, p, error);
    if (!self)
        return NULL;
    material *m = g_new0(material, 1);
    *m = (material){.kind = k, .self = self, .lobes = k->possible_lobes(self)};
    if (!bump_new(&m->bump, context, p, error) || !params_all_used(p, what, error)) {
        material_free(m);
        return NULL;
    }
    return m;
}

void material_free(material *m)
{
    if (!m)
        return;
    m->kind->free(m->self);
    bump_free(m->bump);
    g_free(m->name);
    g_free(m);
}

void material_bsdf(const material *m, const surface_hit *hit, const wavelengths *w,
                   int wavelength, const bsdf_options *options, bsdf *out)
{
    out->shading =
        m->bump ? bump_frame(m->bump, hit) : frame_from_tangent(hit->n, hit->dpdu);
    out->n_geom = hit->n_geom;
    out->wavelength = wavelength;
    out->is_phase = false;
    m->kind->make_bsdf(m->self, hit, w, options, out);
}

bool material_casts_caustics(const material *m)
{
    return m->lobes & (LOBE_SPECULAR | LOBE_GLOSSY);
}

bool material_is_conductor(const material *m)
{
    return m->kind->is_metal && m->kind->is_metal(m->self);
}

const struct medium *material_interior(const material *m)
{
    return m->kind->interior ? m->kind->interior(m->self) : NULL;
}

bool material_encloses(const material *m)
{
    return m->kind->encloses && m->kind->encloses(m->self);
}

bool material_is_pane(const material *m)
{
    return m->kind->is_pane && m->kind->is_pane(m->self);
}
