/* Lambert's law on both sides: paper, leaves, curtains. */
#include "bsdf/bsdf_models.h"
#include "math/warp.h"

typedef struct veil {
    spectrum r, t;
} veil;

_Static_assert(sizeof(veil) <= BSDF_DATA_SIZE, "a veil must fit");

enum {
    BACK = LOBE_DIFFUSE | LOBE_REFLECTION,
    THROUGH = LOBE_DIFFUSE | LOBE_TRANSMISSION,
};

static const veil *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static spectrum veil_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                          transport_mode mode)
{
    (void)mode;
    const veil *v = data_of(b);
    bool same = wo[2] * wi[2] > 0.0f;
    if (!lobe_wanted(lobes, same ? BACK : THROUGH))
        return (spectrum){0};
    return (same ? v->r : v->t) * INV_PI_F;
}

/* The chance that sampling stays on the side of wo. */
static float p_back(const bsdf *b, unsigned lobes)
{
    const veil *v = data_of(b);
    float r = lobe_wanted(lobes, BACK) ? wavelength_mean(b, v->r) : 0.0f;
    float t = lobe_wanted(lobes, THROUGH) ? wavelength_mean(b, v->t) : 0.0f;
    return r + t > 0.0f ? r / (r + t) : -1.0f;
}

static float veil_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                      transport_mode mode)
{
    (void)mode;
    float p = p_back(b, lobes);
    if (p < 0.0f)
        return 0.0f;
    return (wo[2] * wi[2] > 0.0f ? p : 1.0f - p) * fabsf(wi[2]) * INV_PI_F;
}

static bool veil_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                        transport_mode mode, bsdf_sample *out)
{
    (void)mode;
    const veil *v = data_of(b);
    float p = p_back(b, lobes);
    if (p < 0.0f)
        return false;
    bool back = u_lobe < p;
    float share = back ? p : 1.0f - p;
    out->wi = flip_z(warp_cosine_hemisphere(u), (wo[2] < 0.0f) == back);
    out->pdf = share * fabsf(out->wi[2]) * INV_PI_F;
    out->weight = (back ? v->r : v->t) / share;
    out->lobe = back ? BACK : THROUGH;
    return out->pdf > 0.0f;
}

static spectrum veil_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    (void)wo;
    const veil *v = data_of(b);
    spectrum sum = {0};
    if (lobe_wanted(lobes, BACK))
        sum += v->r;
    if (lobe_wanted(lobes, THROUGH))
        sum += v->t;
    return sum;
}

void bsdf_make_diffuse_transmission(bsdf *b, spectrum r, spectrum t)
{
    static const bsdf_ops ops = {
        .name = "diffuse transmission",
        .eval = veil_eval,
        .pdf = veil_pdf,
        .sample = veil_sample,
        .albedo = veil_albedo,
    };
    spectrum sum = r + t;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        if (sum[i] > 1.0f) {
            r[i] /= sum[i];
            t[i] /= sum[i];
        }
    *(veil *)(void *)b->data = (veil){r, t};
    b->ops = &ops;
    b->lobes = BACK | THROUGH;
    b->lambertian = false;
}
