#include "bsdf/fresnel.h"

spectrum fresnel_dielectric_wavelengths(float cos_o, spectrum eta)
{
    spectrum out;
    for (int i = 0; i < N_WAVELENGTHS; i++)
        out[i] = fresnel_dielectric(cos_o, eta[i]);
    return out;
}

spectrum fresnel_conductor(float cos_o, spectrum eta, spectrum k)
{
    float c = minf(fabsf(cos_o), 1.0f), c2 = c * c, s2 = 1.0f - c2;
    /* a + i b is the root of (eta + i k)² - sin², so that a² + b² and a suffice. */
    spectrum real = eta * eta - k * k - s2;
    spectrum imaginary = 2.0f * eta * k;
    spectrum a2_b2 = spectrum_sqrt(real * real + imaginary * imaginary);
    spectrum a = spectrum_sqrt(spectrum_clamp(0.5f * (a2_b2 + real), 0.0f, INFINITY));
    const float tiny = 1e-30f; /* for 0/0 at exactly grazing incidence */
    spectrum sum = a2_b2 + c2, twice = 2.0f * c * a;
    spectrum perpendicular = (sum - twice) / (sum + twice + tiny);
    sum = c2 * a2_b2 + s2 * s2;
    twice *= s2;
    spectrum parallel = perpendicular * (sum - twice) / (sum + twice + tiny);
    return spectrum_clamp(0.5f * (perpendicular + parallel), 0.0f, 1.0f);
}

bool refract3(vec3 w, vec3 m, float eta, vec3 *t)
{
    float cos_o = dot3(w, m);
    float cos_t2 = 1.0f - maxf(0.0f, 1.0f - cos_o * cos_o) / (eta * eta);
    if (!(cos_t2 > 0.0f))
        return false;
    *t = normalize3(m * (cos_o / eta - sqrtf(cos_t2)) - w / eta);
    return true;
}
