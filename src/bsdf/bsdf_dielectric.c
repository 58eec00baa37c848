/*
 * The smooth boundary between two dielectrics. Where the index differs between
 * wavelengths, a reflected ray keeps them all, each with its own Fresnel weight; a
 * refracted one goes the way of one wavelength, chosen at random, and keeps only that.
 *
 * Choices are made in this order, so that weights are as even as they can be: first the
 * wavelength, uniformly, then reflection with that wavelength's Fresnel reflectance. The
 * probability of reflection is then the mean over wavelengths, and a refracted wavelength
 * weighs exactly eight.
 */
#include "bsdf/bsdf_dielectric.h"

static const dielectric *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

spectrum dielectric_eta(const bsdf *b, vec3 wo)
{
    const dielectric *d = data_of(b);
    return wo[2] < 0.0f ? 1.0f / d->eta : d->eta;
}

int dielectric_pick_wavelength(const bsdf *b, float *u)
{
    if (b->wavelength != ALL_WAVELENGTHS)
        return b->wavelength;
    if (!data_of(b)->disperses)
        return 0;
    float x = *u * N_WAVELENGTHS;
    int wavelength = (int)x;
    *u = x - (float)wavelength;
    return wavelength;
}

static bool splits_wavelengths(const bsdf *b)
{
    return b->wavelength == ALL_WAVELENGTHS && data_of(b)->disperses;
}

/* Without loss there is only total reflection. */
static float reflectance(const bsdf *b, float cos_o, float eta)
{
    float r = fresnel_dielectric(cos_o, eta);
    return data_of(b)->lossless && r < 1.0f ? 0.0f : r;
}

static spectrum reflectance_wavelengths(const bsdf *b, float cos_o, spectrum eta)
{
    spectrum out;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        out[i] = reflectance(b, cos_o, eta[i]);
    return out;
}

static bool sample_reflection(const bsdf *b, vec3 wo, spectrum r, bool certain,
                              bsdf_sample *out)
{
    out->wi = vec3_make(-wo[0], -wo[1], wo[2]);
    out->pdf = certain ? 1.0f : wavelength_mean(b, r);
    out->weight = r / out->pdf;
    out->lobe = LOBE_SPECULAR | LOBE_REFLECTION;
    return true;
}

static bool sample_refraction(const bsdf *b, vec3 wo, float eta, int wavelength,
                              float pdf, bsdf_sample *out)
{
    vec3 m = vec3_make(0.0f, 0.0f, copysignf(1.0f, wo[2]));
    if (!refract3(wo, m, eta, &out->wi))
        return false;
    out->pdf = pdf;
    out->eta = eta;
    out->lobe = LOBE_SPECULAR | LOBE_TRANSMISSION;
    if (splits_wavelengths(b)) {
        out->weight = spectrum_wavelength(out->weight * N_WAVELENGTHS, wavelength);
        out->pdf = pdf / N_WAVELENGTHS;
        out->wavelength = wavelength;
    }
    return true;
}

static bool smooth_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                          transport_mode mode, bsdf_sample *out)
{
    (void)u;
    bool reflects = lobe_wanted(lobes, LOBE_SPECULAR | LOBE_REFLECTION);
    bool transmits = lobe_wanted(lobes, LOBE_SPECULAR | LOBE_TRANSMISSION);
    if (!reflects && !transmits)
        return false;
    spectrum eta = dielectric_eta(b, wo);
    float cos_o = fabsf(wo[2]);
    int wavelength = dielectric_pick_wavelength(b, &u_lobe);
    float r = reflectance(b, cos_o, eta[wavelength]);
    if (reflects && (!transmits || u_lobe < r))
        return sample_reflection(b, wo, reflectance_wavelengths(b, cos_o, eta),
                                 !transmits, out);
    float pdf = reflects ? 1.0f - r : 1.0f;
    float scale = mode == TRANSPORT_RADIANCE ? 1.0f / square(eta[wavelength]) : 1.0f;
    if (!(r < 1.0f))
        return false;
    out->weight = data_of(b)->tint * ((1.0f - r) / pdf * scale);
    return sample_refraction(b, wo, eta[wavelength], wavelength, pdf, out);
}

static spectrum smooth_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    spectrum r = reflectance_wavelengths(b, fabsf(wo[2]), dielectric_eta(b, wo)),
             sum = {0};
    if (lobe_wanted(lobes, LOBE_SPECULAR | LOBE_REFLECTION))
        sum += r;
    if (lobe_wanted(lobes, LOBE_SPECULAR | LOBE_TRANSMISSION))
        sum += data_of(b)->tint * (1.0f - r);
    return sum;
}

const bsdf_ops dielectric_smooth_ops = {
    .name = "smooth dielectric",
    .eval = bsdf_delta_eval,
    .pdf = bsdf_delta_pdf,
    .sample = smooth_sample,
    .albedo = smooth_albedo,
};

/* Facets of an index this close to one bend light less than floats can tell. */
static bool bends_nothing(spectrum eta)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        if (fabsf(eta[i] - 1.0f) > 1e-3f)
            return false;
    return true;
}

static void make(bsdf *b, const dielectric *d)
{
    *(dielectric *)(void *)b->data = *d;
    b->ops = ggx_is_smooth(d->roughness) ? &dielectric_smooth_ops : &dielectric_rough_ops;
    b->lobes = ggx_glass_class(d->roughness) | LOBE_ANY_SIDE;
    b->lambertian = false;
}

void bsdf_make_tinted_dielectric(bsdf *b, spectrum eta, bool disperses, ggx roughness,
                                 spectrum tint)
{
    if (bends_nothing(eta))
        roughness = (ggx){0.0f, 0.0f};
    make(b,
         &(dielectric){
             .eta = eta, .tint = tint, .roughness = roughness, .disperses = disperses});
}

void bsdf_make_dielectric(bsdf *b, spectrum eta, bool disperses, ggx roughness)
{
    bsdf_make_tinted_dielectric(b, eta, disperses, roughness, spectrum_fill(1.0f));
}

void bsdf_make_refractor(bsdf *b, spectrum eta, bool disperses)
{
    make(b, &(dielectric){.eta = eta,
                          .tint = spectrum_fill(1.0f),
                          .disperses = disperses,
                          .lossless = true});
}
