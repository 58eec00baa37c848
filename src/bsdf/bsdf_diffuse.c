/* Lambert's law. */
#include "bsdf/bsdf_models.h"
#include "math/warp.h"

enum { DIFFUSE_LOBE = LOBE_DIFFUSE | LOBE_REFLECTION };

static bool reflects(vec3 wo, vec3 wi, unsigned lobes)
{
    return lobe_wanted(lobes, DIFFUSE_LOBE) && wo[2] * wi[2] > 0.0f;
}

static spectrum diffuse_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                             transport_mode mode)
{
    (void)mode;
    return reflects(wo, wi, lobes) ? b->rho * INV_PI_F : (spectrum){0};
}

static float diffuse_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                         transport_mode mode)
{
    (void)b, (void)mode;
    return reflects(wo, wi, lobes) ? fabsf(wi[2]) * INV_PI_F : 0.0f;
}

static bool diffuse_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                           transport_mode mode, bsdf_sample *out)
{
    (void)u_lobe, (void)mode;
    if (!lobe_wanted(lobes, DIFFUSE_LOBE))
        return false;
    out->wi = flip_z(warp_cosine_hemisphere(u), wo[2] < 0.0f);
    out->pdf = fabsf(out->wi[2]) * INV_PI_F;
    out->weight = b->rho;
    out->lobe = DIFFUSE_LOBE;
    return out->pdf > 0.0f;
}

static spectrum diffuse_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    (void)wo;
    return lobe_wanted(lobes, DIFFUSE_LOBE) ? b->rho : (spectrum){0};
}

void bsdf_make_diffuse(bsdf *b, spectrum rho)
{
    static const bsdf_ops ops = {
        .name = "diffuse",
        .eval = diffuse_eval,
        .pdf = diffuse_pdf,
        .sample = diffuse_sample,
        .albedo = diffuse_albedo,
    };
    b->ops = &ops;
    b->lobes = DIFFUSE_LOBE;
    b->lambertian = true;
    b->rho = rho;
}
