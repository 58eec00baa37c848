/*
 * A thin plate: light reflected to and fro between its faces, summed up, direction kept.
 * With the reflectance r of one face and t = 1 - r the whole reflects
 * r + t² r / (1 - r²) = 2 r / (1 + r). Stokes 1862.
 */
#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"

typedef struct plate {
    spectrum eta;
} plate;

_Static_assert(sizeof(plate) <= BSDF_DATA_SIZE, "a plate must fit");

static spectrum plate_reflectance(const bsdf *b, vec3 wo)
{
    const plate *p = (const void *)b->data;
    spectrum r = fresnel_dielectric_wavelengths(fabsf(wo[2]), p->eta);
    return 2.0f * r / (1.0f + r);
}

static bool plate_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                         transport_mode mode, bsdf_sample *out)
{
    (void)u, (void)mode;
    bool reflects = lobe_wanted(lobes & b->lobes, LOBE_SPECULAR | LOBE_REFLECTION);
    bool transmits = lobe_wanted(lobes & b->lobes, LOBE_SPECULAR | LOBE_TRANSMISSION);
    if (!reflects && !transmits)
        return false;
    spectrum r = plate_reflectance(b, wo);
    float p = !transmits ? 1.0f : !reflects ? 0.0f : wavelength_mean(b, r);
    bool mirror = u_lobe < p;
    out->wi = mirror ? vec3_make(-wo[0], -wo[1], wo[2]) : -wo;
    out->pdf = mirror ? p : 1.0f - p;
    out->weight = (mirror ? r : 1.0f - r) / out->pdf;
    out->lobe = LOBE_SPECULAR | (mirror ? LOBE_REFLECTION : LOBE_TRANSMISSION);
    out->straight = !mirror;
    return true;
}

static spectrum plate_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    spectrum r = plate_reflectance(b, wo), sum = {0};
    if (lobe_wanted(lobes, LOBE_SPECULAR | LOBE_REFLECTION))
        sum += r;
    if (lobe_wanted(lobes, LOBE_SPECULAR | LOBE_TRANSMISSION))
        sum += 1.0f - r;
    return sum;
}

static spectrum plate_straight(const bsdf *b, vec3 wo)
{
    return 1.0f - plate_reflectance(b, wo);
}

void bsdf_make_thin_dielectric(bsdf *b, spectrum eta)
{
    static const bsdf_ops ops = {
        .name = "thin dielectric",
        .eval = bsdf_delta_eval,
        .pdf = bsdf_delta_pdf,
        .sample = plate_sample,
        .albedo = plate_albedo,
        .straight = plate_straight,
    };
    *(plate *)(void *)b->data = (plate){eta};
    b->ops = &ops;
    b->lobes = LOBE_SPECULAR | LOBE_ANY_SIDE;
    b->lambertian = false;
}

void bsdf_make_clear(bsdf *b)
{
    bsdf_make_thin_dielectric(b, spectrum_fill(1.0f));
    b->lobes = LOBE_SPECULAR | LOBE_TRANSMISSION;
}
