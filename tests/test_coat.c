/*
 * coat: the closed form of a coated base is the mean of a random walk between its two
 * layers, and loses nothing that it should not.
 *
 * The walk knows only the boundary's own bsdf (tested apart) and Lambert's law. Counts
 * are compared within 5.5 standard errors (p < 1e-7 each, 60 of them) and 0.6 per cent
 * for the table's interpolation, 3 per cent where the coat is brushed.
 */
#include "scene/bsdf_models.h"
#include "scene/fresnel.h"

#include "math/sampler.h"

#include <glib.h>

/* A coat over a base as two surfaces, with light bouncing between them. */
typedef struct layers {
    bsdf coat;
    float rho, thickness;
    int bounces;
} layers;

enum { EXIT_BINS = 6 };

/* Light that leaves towards cosine z counts in a bin of equal cos². */
static int exit_bin(float z)
{
    return MIN((int)(z * z * EXIT_BINS), EXIT_BINS - 1);
}

static bool cross(const layers *l, vec3 wo, sampler *s, vec3 *wi)
{
    bsdf_sample out;
    float u_lobe = sampler_1d(s);
    vec2 u = sampler_2d(s);
    if (!bsdf_sample_direction(&l->coat, wo, u_lobe, u, LOBE_ALL, TRANSPORT_IMPORTANCE,
                               &out))
        return false;
    *wi = out.wi;
    /* What facets hide from each other is lost, as in the weights of one boundary. */
    return sampler_1d(s) < out.weight[0];
}

static float absorb(const layers *l, vec3 w)
{
    return expf(-l->thickness / fabsf(w[2]));
}

/* One walk; *bin of where it leaves, with the weight that is left; 0: it never does. */
static float walk(const layers *l, vec3 from, sampler *s, int *bin, bool *mirrored)
{
    vec3 w;
    float weight = 1.0f;
    *mirrored = false;
    if (!cross(l, from, s, &w))
        return 0.0f;
    *mirrored = w[2] > 0.0f;
    for (int bounce = 0; w[2] < 0.0f; bounce++) {
        if (bounce == l->bounces)
            return 0.0f;
        weight *= l->rho * absorb(l, w);
        vec2 u = sampler_2d(s);
        float z = fmaxf(1e-4f, sqrtf(u.x)), r = sqrtf(1.0f - z * z);
        vec3 up = vec3_make(r * cosf(2 * PI_F * u.y), r * sinf(2 * PI_F * u.y), z);
        weight *= absorb(l, up);
        if (!cross(l, -up, s, &w))
            return 0.0f;
    }
    *bin = exit_bin(w[2]);
    return weight;
}

/* Shares by bin according to the closed form. */
static void closed_form(const bsdf *b, vec3 wo, double shares[EXIT_BINS])
{
    enum { ROWS = 300, COLUMNS = 180 };
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            double z = sqrt((i + 0.5) / ROWS), r = sqrt(1.0 - z * z);
            double phi = 2 * G_PI * (j + 0.5) / COLUMNS;
            vec3 wi = vec3_make((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            spectrum f = bsdf_eval(b, wo, wi, LOBE_ALL, TRANSPORT_IMPORTANCE);
            shares[exit_bin((float)z)] += (double)f[0] * G_PI / (ROWS * COLUMNS);
        }
}

static void check_layers(ggx g, float eta, float rho, float thickness, int bounces)
{
    enum { N = 200000 };
    frame up = frame_from_normal(vec3_make(0, 0, 1));
    layers l = {.coat = {.lane = ALL_LANES, .shading = up, .n_geom = up.n},
                .rho = rho,
                .thickness = thickness,
                .bounces = bounces};
    bsdf_make_dielectric(&l.coat, spectrum_fill(eta), false, g);
    coat_table *table = coat_table_new(&(coat_range){
        fminf(g.alpha_x, g.alpha_y), fmaxf(g.alpha_x, g.alpha_y), eta, eta, thickness});
    bsdf b = {.lane = ALL_LANES, .shading = up, .n_geom = up.n};
    bsdf_make_coated(&b, spectrum_fill(rho), spectrum_fill(eta), g, table, bounces);
    for (int angle = 0; angle < 2; angle++) {
        vec3 from = normalize3(vec3_make(angle ? 2.0f : 0.3f, 0.1f, 1.0f));
        double sums[EXIT_BINS] = {0}, squares[EXIT_BINS] = {0}, truth[EXIT_BINS] = {0};
        for (uint64_t i = 0; i < N; i++) {
            sampler s = sampler_make(23, i);
            int bin = 0;
            bool mirrored;
            double weight = (double)walk(&l, from, &s, &bin, &mirrored);
            if (mirrored && ggx_is_smooth(g))
                continue;
            sums[bin] += weight / N;
            squares[bin] += weight * weight / N;
        }
        closed_form(&b, from, truth);
        bool round = fabsf(g.alpha_x - g.alpha_y) < 1e-6f;
        for (int i = 0; i < EXIT_BINS; i++) {
            double error = sqrt((squares[i] - sums[i] * sums[i]) / N);
            double slack = 5.5 * error + (round ? 0.006 : 0.03) * sums[i];
            if (fabs(sums[i] - truth[i]) > slack)
                g_error("alpha %g, eta %g, rho %g, bin %d: walk %g, closed form %g",
                        (double)g.alpha_x, (double)eta, (double)rho, i, sums[i],
                        truth[i]);
        }
    }
    coat_table_free(table);
}

static void test_layers(void)
{
    check_layers((ggx){0}, 1.5f, 0.5f, 0.01f, 5);
    check_layers((ggx){0}, 1.5f, 0.95f, 0.2f, 100);
    check_layers(ggx_make(0.2f, 0.2f), 1.5f, 0.8f, 0.01f, 5);
    check_layers(ggx_make(0.5f, 0.5f), 1.8f, 0.7f, 0.1f, 3);
    check_layers(ggx_make(0.15f, 0.4f), 1.5f, 0.6f, 0.01f, 5);
}

/* A white base under a smooth coat that absorbs nothing looks white from everywhere. */
static void test_coat_furnace(void)
{
    coat_table *table = coat_table_new(&(coat_range){0, 0, 1.5f, 1.5f, 0});
    frame up = frame_from_normal(vec3_make(0, 0, 1));
    bsdf b = {.lane = ALL_LANES, .shading = up, .n_geom = up.n};
    bsdf_make_coated(&b, spectrum_fill(1.0f), spectrum_fill(1.5f), (ggx){0}, table, 1000);
    for (int i = 1; i < 20; i++) {
        float z = (float)i / 20.0f;
        vec3 wo = vec3_make(sqrtf(1.0f - z * z), 0, z);
        double base[EXIT_BINS] = {0}, sum = 0;
        closed_form(&b, wo, base);
        for (int k = 0; k < EXIT_BINS; k++)
            sum += base[k];
        sum += (double)fresnel_dielectric(z, 1.5f);
        g_assert_cmpfloat(fabs(sum - 1.0), <, 1e-3);
        float albedo = bsdf_albedo(&b, wo, LOBE_ALL)[0];
        g_assert_cmpfloat(fabsf(albedo - 1.0f), <, 1e-3f);
    }
    /* Internal reflection of n = 1.5 for diffuse light is 0.596 (Orchard 1969). */
    g_assert_cmpfloat(fabsf(coat_internal(table, 0, 1.5f) - 0.5963f), <, 1e-3f);
    coat_table_free(table);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/coat/layers", test_layers);
    g_test_add_func("/coat/furnace", test_coat_furnace);
    return g_test_run();
}
