#include "bsdf/coat.h"

#include "bsdf/fresnel.h"

#include <glib.h>

/* Cosines lie at (i / (COSINES - 1))², denser where Fresnel's curve is steep. */
enum { COSINES = 64, ALPHAS = 16, ETAS = 5, FACETS = 16, FLAT_STEPS = 1024 };

/* Equidistant nodes. */
typedef struct axis {
    float first, step;
    int n;
} axis;

/* The numbers at one node of alpha and eta. */
typedef struct coat_node {
    float reflected[COSINES], crossing[COSINES];
    float internal, escape;
} coat_node;

struct coat_table {
    axis alpha, eta;
    float thickness;
    coat_node *nodes; /* eta runs fastest */
};

/* Light that meets the boundary. */
typedef struct boundary {
    ggx roughness;
    float eta; /* far over near */
    float thickness;
} boundary;

static float attenuation(float thickness, float cosine)
{
    return thickness > 0.0f ? expf(-thickness / maxf(cosine, 1e-6f)) : 1.0f;
}

/* Shares of light from cosine mu that leave again on this side and on the other, each
 * weighed with the attenuation along its way if it runs within the coat. */
static void meet(const boundary *at, float mu, bool inside, double *back, double *through)
{
    float depth_back = inside ? at->thickness : 0.0f;
    float depth_through = inside ? 0.0f : at->thickness;
    vec3 o = vec3_make(sqrtf(maxf(0.0f, 1.0f - mu * mu)), 0.0f, maxf(mu, 1e-5f)), t;
    int n = ggx_is_smooth(at->roughness) ? 1 : FACETS;
    *back = *through = 0.0;
    for (int k = 0; k < n * n; k++) {
        vec2 u = {((float)(k / n) + 0.5f) / (float)n, ((float)(k % n) + 0.5f) / (float)n};
        vec3 m = n == 1 ? vec3_make(0, 0, 1) : ggx_sample_visible(at->roughness, o, u);
        float r = fresnel_dielectric(dot3(o, m), at->eta), share = 1.0f / (float)(n * n);
        vec3 i = reflect3(o, m);
        if (i[2] > 0.0f)
            *back += (double)(share * r * ggx_visible_weight(at->roughness, o, i) *
                              attenuation(depth_back, i[2]));
        if (refract3(o, m, at->eta, &t) && t[2] < 0.0f)
            *through +=
                (double)(share * (1.0f - r) * ggx_visible_weight(at->roughness, o, t) *
                         attenuation(depth_through, -t[2]));
    }
}

static float cosine_of(int i)
{
    return square((float)i / (COSINES - 1));
}

/* ∫ of shares from within, for Lambert's law: 2 ∫ share(μ) exp(-thickness/μ) μ dμ. */
static void fill_internal(coat_node *out, const boundary *at)
{
    boundary below = *at;
    below.eta = 1.0f / at->eta;
    int n = ggx_is_smooth(at->roughness) ? FLAT_STEPS : COSINES;
    double internal = 0.0, escape = 0.0;
    for (int i = 0; i < n; i++) {
        float mu = ((float)i + 0.5f) / (float)n;
        double back, through;
        meet(&below, mu, true, &back, &through);
        double weight = 2.0 * (double)(mu * attenuation(at->thickness, mu)) / n;
        internal += weight * back;
        escape += weight * through;
    }
    out->internal = (float)internal;
    out->escape = (float)escape;
}

static void fill_node(coat_node *out, const boundary *at)
{
    for (int i = 0; i < COSINES; i++) {
        double back, through;
        meet(at, cosine_of(i), false, &back, &through);
        out->reflected[i] = (float)back;
        out->crossing[i] = (float)through;
    }
    fill_internal(out, at);
}

static axis make_axis(float min, float max, int n)
{
    if (!(max - min > 1e-5f * max))
        return (axis){min, 0.0f, 1};
    return (axis){min, (max - min) / (float)(n - 1), n};
}

coat_table *coat_table_new(const coat_range *range)
{
    coat_table *table = g_new0(coat_table, 1);
    table->alpha = make_axis(range->alpha_min, range->alpha_max, ALPHAS);
    table->eta = make_axis(range->eta_min, range->eta_max, ETAS);
    table->thickness = range->thickness;
    table->nodes = g_new(coat_node, (gsize)table->alpha.n * (gsize)table->eta.n);
    for (int i = 0; i < table->alpha.n; i++)
        for (int j = 0; j < table->eta.n; j++) {
            float alpha = table->alpha.first + (float)i * table->alpha.step;
            boundary at = {.roughness = ggx_make(alpha, alpha),
                           .eta = table->eta.first + (float)j * table->eta.step,
                           .thickness = range->thickness};
            fill_node(&table->nodes[i * table->eta.n + j], &at);
        }
    return table;
}

void coat_table_free(coat_table *table)
{
    if (!table)
        return;
    g_free(table->nodes);
    g_free(table);
}

/* The node below x, and how far x is on the way to the next. */
static int find(const axis *a, float x, float *rest)
{
    *rest = 0.0f;
    if (a->n == 1)
        return 0;
    float place = clampf((x - a->first) / a->step, 0.0f, (float)(a->n - 1));
    int i = MIN((int)place, a->n - 2);
    *rest = place - (float)i;
    return i;
}

coat_response coat_find(const coat_table *table, float alpha, float eta)
{
    float a, e;
    int i = find(&table->alpha, alpha, &a), j = find(&table->eta, eta, &e);
    coat_response c = {
        .smooth = alpha < SMOOTH_ALPHA, .eta = eta, .thickness = table->thickness};
    for (int k = 0; k < 4; k++) {
        float weight = (k & 2 ? a : 1.0f - a) * (k & 1 ? e : 1.0f - e);
        if (!(weight > 0.0f))
            continue;
        c.nodes[c.n] = &table->nodes[(i + (k >> 1)) * table->eta.n + j + (k & 1)];
        c.weights[c.n++] = weight;
    }
    return c;
}

/* The interval of the cosines that mu is in, and how far it is on the way to its end. */
static int find_cosine(float mu, float *rest)
{
    float place = sqrtf(clampf(mu, 0.0f, 1.0f)) * (COSINES - 1);
    int i = MIN((int)place, COSINES - 2);
    float low = cosine_of(i);
    *rest = (mu - low) / (cosine_of(i + 1) - low);
    return i;
}

float coat_reflected(const coat_response *c, float mu)
{
    if (c->smooth)
        return fresnel_dielectric(mu, c->eta);
    float rest, sum = 0.0f;
    int i = find_cosine(mu, &rest);
    for (int k = 0; k < c->n; k++) {
        const float *values = &c->nodes[k]->reflected[i];
        sum += c->weights[k] * lerpf(values[0], values[1], rest);
    }
    return sum;
}

float coat_crossing(const coat_response *c, float mu)
{
    if (c->smooth) {
        float cos_t2 = 1.0f - (1.0f - mu * mu) / (c->eta * c->eta);
        return (1.0f - fresnel_dielectric(mu, c->eta)) *
               attenuation(c->thickness, sqrtf(maxf(cos_t2, 0.0f)));
    }
    float rest, sum = 0.0f;
    int i = find_cosine(mu, &rest);
    for (int k = 0; k < c->n; k++) {
        const float *values = &c->nodes[k]->crossing[i];
        sum += c->weights[k] * lerpf(values[0], values[1], rest);
    }
    return sum;
}

float coat_internal(const coat_response *c)
{
    float sum = 0.0f;
    for (int k = 0; k < c->n; k++)
        sum += c->weights[k] * c->nodes[k]->internal;
    return sum;
}

float coat_escape(const coat_response *c)
{
    float sum = 0.0f;
    for (int k = 0; k < c->n; k++)
        sum += c->weights[k] * c->nodes[k]->escape;
    return sum;
}
