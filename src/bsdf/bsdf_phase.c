/*
 * What a medium does with light that it scatters, by Henyey and Greenstein:
 *
 *     p(wo, wi) = (1 - g²) / (4π (1 + g² + 2 g wo·wi)^(3/2))
 *
 * Both directions point away from the point, so light that goes straight on has
 * wo·wi = -1.
 */
#include "bsdf/bsdf_models.h"
#include "math/warp.h"
#include "medium/medium.h"

enum { PHASE_LOBE = LOBE_DIFFUSE | LOBE_ANY_SIDE };

typedef struct phase {
    float g;
} phase;

_Static_assert(sizeof(phase) <= BSDF_DATA_SIZE, "a phase function must fit");

static const phase *phase_of(const bsdf *b)
{
    return (const phase *)b->data;
}

static float phase_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                       transport_mode mode)
{
    (void)mode;
    return lobe_wanted(lobes, PHASE_LOBE)
               ? phase_henyey_greenstein(phase_of(b)->g, dot3(wo, wi))
               : 0.0f;
}

static spectrum phase_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                           transport_mode mode)
{
    return spectrum_fill(phase_pdf(b, wo, wi, lobes, mode));
}

/* cosθ of the way on, by inverting the distribution; near g = 0 that would lose digits.
 */
static float sample_cosine(float g, float u)
{
    if (fabsf(g) < 1e-3f)
        return 2.0f * u - 1.0f;
    float s = (1.0f - g * g) / (1.0f - g + 2.0f * g * u);
    return clampf((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
}

static bool phase_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                         transport_mode mode, bsdf_sample *out)
{
    (void)u_lobe, (void)mode;
    if (!lobe_wanted(lobes, PHASE_LOBE))
        return false;
    const frame on = frame_from_normal(-wo);
    float cosine = sample_cosine(phase_of(b)->g, u.x), angle = 2.0f * PI_F * u.y;
    float sine = sqrtf(maxf(1.0f - cosine * cosine, 0.0f));
    out->wi = normalize3(
        frame_to_world(&on, vec3_make(sine * cosf(angle), sine * sinf(angle), cosine)));
    out->pdf = phase_henyey_greenstein(phase_of(b)->g, dot3(wo, out->wi));
    out->weight = spectrum_fill(1.0f);
    out->lobe = PHASE_LOBE;
    return out->pdf > 0.0f;
}

static spectrum phase_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    (void)b, (void)wo;
    return spectrum_fill(lobe_wanted(lobes, PHASE_LOBE) ? 1.0f : 0.0f);
}

void bsdf_make_phase(bsdf *b, float g, int wavelength)
{
    static const bsdf_ops ops = {
        .name = "phase",
        .eval = phase_eval,
        .pdf = phase_pdf,
        .sample = phase_sample,
        .albedo = phase_albedo,
    };
    b->ops = &ops;
    b->lobes = PHASE_LOBE;
    b->wavelength = wavelength;
    b->is_phase = true;
    b->lambertian = false;
    b->n_geom = (vec3){0};
    b->shading = (frame){0};
    *(phase *)b->data = (phase){g};
}
