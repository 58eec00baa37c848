/*
 * light: what a light emits, what is aimed at a target and what arrives by sampling are
 * three ways to the same flux, and for plain cases to the closed form; directions follow
 * the densities that are claimed; scales are pbrt's.
 *
 * Statistical tests: six standard errors, chi-square below its 1 - 1e-6 quantile.
 */
#include "light/light_kinds.h"
#include "math/frame.h"
#include "shape_subjects.h"

/* ---- Lights to test ---- */

typedef struct lamp {
    light *l;
    shape *on;
    accel *around; /* of the shape */
} lamp;

static params *numbers_of(const char *first, ...)
{
    params *p = params_new(here, "/", color_space_srgb());
    va_list args;
    va_start(args, first);
    for (const char *name = first; name; name = va_arg(args, const char *)) {
        float value = (float)va_arg(args, double);
        params_add_numbers(p, here, PARAM_FLOAT, name, &value, 1, NULL);
    }
    va_end(args);
    return p;
}

static void add_point(params *p, const char *name, float x, float y, float z)
{
    const float numbers[3] = {x, y, z};
    params_add_numbers(p, here, PARAM_POINT3, name, numbers, 3, NULL);
}

static lamp make_lamp(const char *kind, const params *p, shape *on)
{
    GError *error = NULL;
    transform identity = transform_identity();
    lamp out = {.on = on};
    out.l = light_new(NULL, kind, p, &identity, on, &error);
    g_assert_no_error(error);
    if (on) {
        on->light = 0;
        out.around = accel_of(&out.on, 1);
    }
    if (out.l->kind->prepare)
        out.l->kind->prepare(out.l->self, vec3_make(0.1f, 0.2f, -0.3f), 3.0f);
    return out;
}

static void clear_lamp(lamp *a)
{
    accel_free(a->around);
    light_free(a->l);
    shape_free(a->on);
}

static const char *const lamp_names[] = {
    "point",  "spot",           "narrow spot", "distant",   "sky",
    "sphere", "two-sided disk", "quad",        "ellipsoid", "half cylinder"};

/* All lights, above the square -1..1 in the plane z = 0, shining down on it. */
static lamp lamp_number(size_t i)
{
    g_autoptr(params) p = numbers_of("scale", 3.0, NULL);
    shape_place at = {.to_world = transform_translate(0.3, 0.2, 2),
                      .reverse_orientation = false};
    transform stretch = transform_scale(0.8, 0.3, 0.5);
    transform turn = transform_rotate(i == 9 ? -60 : 40, 1, 0.3, 0);
    if (i < 4) {
        add_point(p, "from", 0.3f, -0.2f, 2.2f);
        if (i > 0)
            add_point(p, "to", 0.1f, 0.4f, 0.0f);
    }
    if (i == 2) {
        const float angles[2] = {6.0f, 5.0f};
        params_add_numbers(p, here, PARAM_FLOAT, "coneangle", &angles[0], 1, NULL);
        params_add_numbers(p, here, PARAM_FLOAT, "conedeltaangle", &angles[1], 1, NULL);
    }
    if (i < 5) {
        const char *kinds[] = {"point", "spot", "spot", "distant", "infinite"};
        return make_lamp(kinds[i], p, NULL);
    }
    if (i == 6) {
        const int yes = 1;
        params_add_integers(p, here, PARAM_BOOL, "twosided", &yes, 1, NULL);
    }
    if (i == 7) /* the square's front is up: turn it round */
        at.reverse_orientation = true;
    if (i >= 6)
        at.to_world = transform_multiply(&at.to_world, &turn);
    if (i == 8)
        at.to_world = transform_multiply(&at.to_world, &stretch);
    const subject subjects[] = {{"sphere", 0.6f, -0.6f, 0.6f, 360, 0},
                                {"disk", 0.7f, 0, 0, 360, 0.2f},
                                {"", 0, 0, 0, 0, 0},
                                {"sphere", 1, -1, 1, 360, 0},
                                {"cylinder", 0.5f, -0.5f, 0.5f, 180, 0}};
    return make_lamp("diffuse", p,
                     i == 7 ? unit_square(&at) : make(&subjects[i - 5], &at));
}

/* ---- Three ways to the flux through the square -1..1 at z = 0 ---- */

typedef struct tally {
    double sum, sum2;
    unsigned n;
} tally;

static void add_to(tally *t, double x)
{
    t->sum += x;
    t->sum2 += x * x;
    t->n++;
}

static double mean_of(const tally *t)
{
    return t->sum / t->n;
}

static double error_of(const tally *t)
{
    double mean = mean_of(t);
    return sqrt(fmax(0, t->sum2 / t->n - mean * mean) / t->n);
}

static bool lies_before(const lamp *a, vec3 from, vec3 direction, float distance)
{
    ray r = {from, direction, distance * 0.9999f, 0, {{0}, 0}};
    return a->around && accel_occluded(a->around, &r);
}

/* Crosses z = 0 downward inside the square, seen from the light without hindrance. */
static double through_square(const lamp *a, const ray *r)
{
    float t = -r->origin[2] / r->direction[2];
    vec3 p = r->origin + t * r->direction;
    bool inside = r->direction[2] < 0 && t > 0 && fabsf(p[0]) < 1 && fabsf(p[1]) < 1;
    return inside && !lies_before(a, r->origin, r->direction, t) ? 1 : 0;
}

static double by_emission(const lamp *a, const wavelengths *w, sampler *s)
{
    light_emission e;
    vec2 u_position = sampler_2d(s), u_direction = sampler_2d(s);
    if (!a->l->kind->emit(a->l->self, w, sampler_1d(s), u_position, u_direction, &e))
        return 0;
    return (double)spectrum_mean(e.flux) * through_square(a, &e.ray);
}

static double by_aiming(const lamp *a, const wavelengths *w, sampler *s)
{
    vec2 u = sampler_2d(s), v = sampler_2d(s);
    vec3 y = vec3_make(2 * v.x - 1, 2 * v.y - 1, 0);
    light_emission e;
    if (!a->l->kind->emit_toward(a->l->self, w, sampler_1d(s), u, y, &e))
        return 0;
    vec3 d = y - e.ray.origin;
    float distance = length3(d), cosine = -e.ray.direction[2];
    g_assert_cmpfloat(dot3(d, e.ray.direction), >, 0.9999f * distance);
    if (cosine <= 0 || lies_before(a, e.ray.origin, e.ray.direction, distance))
        return 0;
    bool is_far = a->l->kind->prepare != NULL;
    /* density of the position across the ray, or of the direction */
    double density = is_far ? 1 / (4.0 * (double)cosine)
                            : (double)(distance * distance / (4 * cosine));
    return (double)spectrum_mean(e.flux) / density;
}

static double by_sampling(const lamp *a, const wavelengths *w, sampler *s)
{
    vec2 u = sampler_2d(s), v = sampler_2d(s);
    vec3 y = vec3_make(2 * v.x - 1, 2 * v.y - 1, 0);
    light_sample to;
    if (!a->l->kind->sample(a->l->self, w, y, sampler_1d(s), u, &to) || to.wi[2] <= 0 ||
        lies_before(a, y, to.wi, to.distance))
        return 0;
    return 4.0 * (double)(spectrum_mean(to.radiance) * to.wi[2] / to.pdf);
}

static void test_three_ways_to_one_flux(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    double (*const ways[3])(const lamp *, const wavelengths *,
                            sampler *) = {by_emission, by_aiming, by_sampling};
    for (size_t i = 0; i < G_N_ELEMENTS(lamp_names); i++) {
        lamp a = lamp_number(i);
        tally t[3] = {0};
        for (uint32_t n = 0; n < 60000; n++) {
            for (int k = 0; k < 3; k++) {
                sampler s = sampler_make(7 + (uint64_t)k, n);
                add_to(&t[k], ways[k](&a, &w, &s));
            }
        }
        g_test_message("%s: %g %g %g", lamp_names[i], mean_of(&t[0]), mean_of(&t[1]),
                       mean_of(&t[2]));
        for (int k = 0; k < 2; k++) {
            double error = hypot(error_of(&t[k]), error_of(&t[2]));
            g_assert_cmpfloat(fabs(mean_of(&t[k]) - mean_of(&t[2])), <,
                              6 * error + 1e-4 * mean_of(&t[2]));
            g_assert_cmpfloat(error, <, 0.04 * mean_of(&t[2]));
        }
        clear_lamp(&a);
    }
}

/* ---- Power and densities ---- */

static void check_emission(const lamp *a, const wavelengths *w, const light_emission *e)
{
    float position, direction;
    a->l->kind->emit_pdf(a->l->self, e->ray.origin, e->n, e->ray.direction, &position,
                         &direction);
    g_assert_cmpfloat(fabsf(position / e->pdf_position - 1), <, 1e-4);
    g_assert_cmpfloat(fabsf(direction - e->pdf_direction), <=, 1e-4f * direction);
    g_assert_cmpfloat(fabsf(length3(e->ray.direction) - 1), <, 1e-5);
    float flux = spectrum_mean(e->flux);
    if (!a->on) { /* the density times the flux is what arrives, from a point at 1 m */
        light_sample to;
        vec3 ref = e->ray.origin + e->ray.direction;
        g_assert_true(a->l->kind->sample(a->l->self, w, ref, 0, (vec2){0, 0}, &to));
        float expected = spectrum_mean(to.radiance);
        g_assert_cmpfloat(fabsf(flux * position * direction / expected - 1), <, 1e-3);
        return;
    }
    /* flux = L cosθ / (pdf pdf) */
    surface_hit hit = {.n_geom = e->n};
    float le = spectrum_mean(a->l->kind->radiance(a->l->self, &hit, e->ray.direction, w));
    float cosine = fabsf(dot3(e->n, e->ray.direction));
    if (cosine > 1e-3f)
        g_assert_cmpfloat(fabsf(le * cosine / (position * direction) / flux - 1), <,
                          1e-3);
}

static void test_mean_flux_is_power(void)
{
    const wavelengths w = wavelengths_at(0.25f);
    for (size_t i = 0; i < G_N_ELEMENTS(lamp_names); i++) {
        lamp a = lamp_number(i);
        double power = (double)spectrum_mean(a.l->kind->power(a.l->self, &w));
        tally t = {0};
        for (uint32_t n = 0; n < 4000; n++) {
            sampler s = sampler_make(17, n);
            vec2 u = sampler_2d(&s), v = sampler_2d(&s);
            light_emission e = {0};
            bool left = a.l->kind->emit(a.l->self, &w, sampler_1d(&s), u, v, &e);
            add_to(&t, left ? (double)spectrum_mean(e.flux) : 0);
            if (left)
                check_emission(&a, &w, &e);
        }
        g_assert_cmpfloat(fabs(mean_of(&t) - power), <, 6 * error_of(&t) + 1e-4 * power);
        clear_lamp(&a);
    }
}

/* The power of a spot by quadrature of what sample gives on a sphere around it. */
static void test_spot_power_by_quadrature(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    for (int i = 0; i < 3; i++) {
        const double angles[3][2] = {{30, 5}, {80, 80}, {170, 0}};
        g_autoptr(params) p =
            numbers_of("coneangle", angles[i][0], "conedeltaangle", angles[i][1], NULL);
        lamp a = make_lamp("spot", p, NULL);
        enum { STEPS_Y = 20000 };
        double sum = 0;
        for (int k = 0; k < STEPS_Y; k++) {
            double z = 1 - (k + 0.5) * 2 / STEPS_Y;
            vec3 ref = vec3_make((float)sqrt(1 - z * z), 0, (float)z);
            light_sample to;
            if (a.l->kind->sample(a.l->self, &w, ref, 0, (vec2){0, 0}, &to))
                sum += (double)spectrum_mean(to.radiance) * 4 * G_PI / STEPS_Y;
        }
        double power = (double)spectrum_mean(a.l->kind->power(a.l->self, &w));
        g_assert_cmpfloat(fabs(sum / power - 1), <, 1e-3);
        clear_lamp(&a);
    }
}

enum { BINS_Z = 24, BINS_PHI = 16, N_DIRECTIONS = 40000 };

static int direction_bin(const frame *f, float z_low, vec3 w)
{
    vec3 local = frame_to_local(f, w);
    float z = (local[2] - z_low) / (1 - z_low), phi = atan2f(local[1], local[0]);
    int i = CLAMP((int)(z * BINS_Z), 0, BINS_Z - 1);
    int k = CLAMP((int)((phi / PI_F + 1) * 0.5f * BINS_PHI), 0, BINS_PHI - 1);
    return i * BINS_PHI + k;
}

/* Chi-square of counts against expected shares, small bins pooled. */
static void assert_follows(const unsigned *count, const double *share, int n)
{
    double chi2 = 0, pooled = 0, pooled_count = 0, freedom = -1;
    for (int i = 0; i < n; i++) {
        double mean = share[i] * N_DIRECTIONS;
        if (mean < 8) {
            pooled += mean;
            pooled_count += count[i];
            continue;
        }
        chi2 += (count[i] - mean) * (count[i] - mean) / mean;
        freedom++;
    }
    if (pooled > 8) {
        chi2 += (pooled_count - pooled) * (pooled_count - pooled) / pooled;
        freedom++;
    } else {
        g_assert_cmpfloat(pooled_count, <, pooled + 6 * sqrt(pooled) + 8);
    }
    g_assert_cmpfloat(freedom, >, 3);
    g_assert_cmpfloat(chi2, <, chi2_limit(freedom));
}

/* The density of a direction that is given in the local frame. */
typedef float (*density)(const lamp *a, vec3 ref, vec3 direction);

static void integrate_bins(const lamp *a, vec3 ref, const frame *f, float z_low,
                           density pdf, double *share)
{
    enum { FINE = 16 };
    float cell = (1 - z_low) / (BINS_Z * FINE) * 2 * PI_F / (BINS_PHI * FINE);
    for (int i = 0; i < BINS_Z * FINE; i++) {
        for (int k = 0; k < BINS_PHI * FINE; k++) {
            float z = z_low + (1 - z_low) * ((float)i + 0.5f) / (BINS_Z * FINE);
            float phi = (((float)k + 0.5f) / (BINS_PHI * FINE) * 2 - 1) * PI_F;
            float r = sqrtf(fmaxf(0, 1 - z * z));
            vec3 local = vec3_make(r * cosf(phi), r * sinf(phi), z);
            share[i / FINE * BINS_PHI + k / FINE] +=
                (double)(cell * pdf(a, ref, frame_to_world(f, local)));
        }
    }
}

static float emission_density(const lamp *a, vec3 n, vec3 direction)
{
    float position, pdf;
    a->l->kind->emit_pdf(a->l->self, n, n, direction, &position, &pdf);
    return pdf;
}

/* Lights that emit around one axis from every position. */
static void test_emitted_directions(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    const size_t numbers[] = {0, 1, 2, 4, 6, 7};
    for (size_t i = 0; i < G_N_ELEMENTS(numbers); i++) {
        lamp a = lamp_number(numbers[i]);
        unsigned count[BINS_Z * BINS_PHI] = {0};
        double share[BINS_Z * BINS_PHI] = {0};
        vec3 n = normalize3(vec3_make(0.1f - 0.3f, 0.4f + 0.2f, -2.2f)); /* spot's axis */
        if (a.on)
            n = shape_sample_area(a.on, 0, (vec2){0, 0}).n;
        frame f = frame_from_normal(n);
        const float z_low = numbers[i] == 1 ? 0.8f : numbers[i] == 2 ? 0.994f : -1.0f;
        for (uint32_t k = 0; k < N_DIRECTIONS; k++) {
            sampler s = sampler_make(27, k);
            s.dimension = 40;
            vec2 u = sampler_2d(&s), v = sampler_2d(&s);
            light_emission e;
            g_assert_true(a.l->kind->emit(a.l->self, &w, sampler_1d(&s), u, v, &e));
            count[direction_bin(&f, z_low, e.ray.direction)]++;
        }
        integrate_bins(&a, n, &f, z_low, emission_density, share);
        assert_follows(count, share, BINS_Z * BINS_PHI);
        clear_lamp(&a);
    }
}

static float sampled_density(const lamp *a, vec3 ref, vec3 direction)
{
    if (!a->on)
        return a->l->kind->pdf(a->l->self, ref, direction, NULL);
    ray r = {ref, direction, INFINITY, 0, {{0}, 0}};
    surface_hit hit;
    float sum = 0;
    /* samples fall on far sides too: all hits on the line count */
    for (int i = 0; i < 4 && accel_intersect(a->around, &r, &hit); i++) {
        vec3 wo = -direction;
        const wavelengths w = wavelengths_at(0.5f);
        if (!spectrum_is_black(a->l->kind->radiance(a->l->self, &hit, wo, &w)))
            sum += a->l->kind->pdf(a->l->self, ref, direction, &hit);
        r.origin = hit_offset(&hit, direction);
    }
    return sum;
}

static void test_sampled_directions(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    for (size_t i = 4; i < G_N_ELEMENTS(lamp_names); i++) {
        lamp a = lamp_number(i);
        unsigned count[BINS_Z * BINS_PHI] = {0};
        double share[BINS_Z * BINS_PHI] = {0};
        const vec3 ref = vec3_make(-0.3f, 0.1f, 0.4f);
        frame f = frame_from_normal(normalize3(vec3_make(0.3f, 0.2f, 2) - ref));
        float z_low = i == 4 ? -1.0f : i == 7 ? 0.6f : 0.85f;
        unsigned lost = 0;
        for (uint32_t k = 0; k < N_DIRECTIONS; k++) {
            sampler s = sampler_make(37, k);
            s.dimension = 40;
            vec2 u = sampler_2d(&s);
            light_sample to;
            if (a.l->kind->sample(a.l->self, &w, ref, sampler_1d(&s), u, &to))
                count[direction_bin(&f, z_low, to.wi)]++;
            else
                lost++; /* on the dark side */
        }
        integrate_bins(&a, ref, &f, z_low, sampled_density, share);
        double total = 0;
        for (int k = 0; k < BINS_Z * BINS_PHI; k++)
            total += share[k];
        double kept = 1 - (double)lost / N_DIRECTIONS;
        g_assert_cmpfloat(fabs(total - kept), <, 6 * 0.5 / sqrt(N_DIRECTIONS) + 2e-3);
        assert_follows(count, share, BINS_Z * BINS_PHI);
        clear_lamp(&a);
    }
}

/* ---- Closed forms on the plane z = 0 ---- */

static double irradiance(const lamp *a, vec3 ref, vec3 n)
{
    const wavelengths w = wavelengths_at(0.5f);
    enum { N = 1 << 15 };
    double sum = 0;
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(47, i);
        vec2 u = sampler_2d(&s);
        light_sample to;
        if (a->l->kind->sample(a->l->self, &w, ref, sampler_1d(&s), u, &to))
            sum +=
                (double)(spectrum_mean(to.radiance) * fmaxf(0, dot3(to.wi, n)) / to.pdf);
    }
    return sum / N;
}

/* Radiance, intensity or irradiance of a light of scale 1 at these wavelengths. */
static double unit_emission(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    g_autoptr(params) p = params_new(here, "/", color_space_srgb());
    emitter e;
    g_assert_true(emitter_init(&e, p, "L", NULL, NULL));
    double value = (double)spectrum_mean(emitter_eval(&e, &w));
    emitter_clear(&e);
    return value;
}

static void assert_irradiance(lamp *a, vec3 ref, vec3 n, double expected,
                              double tolerance)
{
    double found = irradiance(a, ref, n) / unit_emission();
    g_assert_cmpfloat(fabs(found / expected - 1), <, tolerance);
    clear_lamp(a);
}

static void test_irradiance_of_point_spot_and_sky(void)
{
    const vec3 up = vec3_make(0, 0, 1), ref = vec3_make(0.5f, 0, 0);
    g_autoptr(params) p = params_new(here, "/", color_space_srgb());
    add_point(p, "from", 0, 0, 2);
    lamp a = make_lamp("point", p, NULL);
    assert_irradiance(&a, ref, up, 2 / pow(4.25, 1.5), 1e-5);
    add_point(p, "to", 0, 0, 0);
    a = make_lamp("spot", p, NULL); /* at 14 degrees: in full light */
    assert_irradiance(&a, ref, up, 2 / pow(4.25, 1.5), 1e-5);
    a = make_lamp("spot", p, NULL);
    double x = (cos(28 * G_PI / 180) - cos(30 * G_PI / 180)) /
               (cos(25 * G_PI / 180) - cos(30 * G_PI / 180));
    vec3 edge = vec3_make((float)(2 * tan(28 * G_PI / 180)), 0, 0);
    assert_irradiance(&a, edge, up,
                      x * x * (3 - 2 * x) * pow(cos(28 * G_PI / 180), 3) / 4, 1e-3);
    g_autoptr(params) q = params_new(here, "/", color_space_srgb());
    a = make_lamp("infinite", q, NULL);
    assert_irradiance(&a, ref, up, G_PI, 1e-3);
    add_point(q, "from", 3, 0, 4);
    add_point(q, "to", 0, 0, 0);
    a = make_lamp("distant", q, NULL);
    assert_irradiance(&a, ref, up, 0.8, 1e-5);
}

/* A sphere wholly above the horizon: E = π L sin²θ cos(tilt). */
static void test_irradiance_of_sphere(void)
{
    g_autoptr(params) p = params_new(here, "/", color_space_srgb());
    for (int i = 0; i < 3; i++) {
        const float radius[3] = {1.5f, 0.1f, 1e-4f};
        subject ball = {"sphere", radius[i], -radius[i], radius[i], 360, 0};
        shape_place at = {.to_world = transform_translate(1, 0, 2)};
        lamp a = make_lamp("diffuse", p, make(&ball, &at));
        double sine2 = (double)(radius[i] * radius[i]) / 5;
        assert_irradiance(&a, vec3_make(0, 0, 0), vec3_make(0, 0, 1),
                          G_PI * sine2 * 2 / sqrt(5), 2e-3);
    }
}

/* Lambert 1760: E = L/2 Σ angle(edge) n·(v_i × v_i+1)/|v_i × v_i+1|. */
static double lambert(const vec3 corners[4], vec3 n)
{
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        vec3 a = normalize3(corners[i]), b = normalize3(corners[(i + 1) % 4]);
        sum += (double)(acosf(dot3(a, b)) * dot3(normalize3(cross3(a, b)), n));
    }
    return 0.5 * fabs(sum);
}

static void test_irradiance_of_quad(void)
{
    const vec3 n = normalize3(vec3_make(0.2f, -0.1f, 1));
    g_autoptr(params) p = params_new(here, "/", color_space_srgb());
    for (int i = 0; i < 2; i++) {
        transform move = transform_translate(0.5, 0.2, 3);
        transform turn = transform_rotate(i ? 150 : 180, 0.3, 1, 0);
        shape_place at = {.to_world = transform_multiply(&move, &turn)};
        vec3 corners[4];
        for (int k = 0; k < 4; k++)
            corners[k] = transform_point(
                &at.to_world, vec3_make(k == 1 || k == 2 ? 1 : -1, k > 1 ? 1 : -1, 0));
        lamp a = make_lamp("diffuse", p, unit_square(&at));
        assert_irradiance(&a, vec3_make(0, 0, 0), n, lambert(corners, n), 2e-3);
    }
}

/* ---- Sides, scales ---- */

static void test_sides(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    for (int i = 0; i < 4; i++) {
        bool reverse = i & 1;
        const int two_sided = i >> 1;
        g_autoptr(params) p = params_new(here, "/", color_space_srgb());
        params_add_integers(p, here, PARAM_BOOL, "twosided", &two_sided, 1, NULL);
        shape_place at = {.to_world = transform_identity(),
                          .reverse_orientation = reverse};
        lamp a = make_lamp("diffuse", p, unit_square(&at));
        light_sample to;
        for (int side = 0; side < 2; side++) {
            vec3 ref = vec3_make(0.1f, 0.2f, side ? -1 : 1);
            bool lit = two_sided || (side == 1) == reverse;
            bool found =
                a.l->kind->sample(a.l->self, &w, ref, 0.3f, (vec2){0.2f, 0.6f}, &to);
            g_assert_cmpint(found, ==, lit);
            ray r = {ref, {0, 0, -ref[2]}, INFINITY, 0, {{0}, 0}};
            surface_hit hit;
            g_assert_true(accel_intersect(a.around, &r, &hit));
            spectrum seen = a.l->kind->radiance(a.l->self, &hit, -r.direction, &w);
            g_assert_cmpint(!spectrum_is_black(seen), ==, lit);
        }
        unsigned up = 0;
        for (uint32_t k = 0; k < 1000; k++) {
            sampler s = sampler_make(57, k);
            vec2 u = sampler_2d(&s);
            light_emission e;
            g_assert_true(a.l->kind->emit(a.l->self, &w, 0.5f, u, sampler_2d(&s), &e));
            up += e.ray.direction[2] > 0;
            g_assert_false(accel_occluded(a.around, &e.ray));
        }
        g_assert_cmpuint(up, >=, two_sided ? 490 : reverse ? 0 : 1000);
        g_assert_cmpuint(up, <=, two_sided ? 510 : reverse ? 0 : 1000);
        clear_lamp(&a);
    }
}

/* Mean over passes of the Y of a spectrum made by `power` or the like. */
static double luminance(const light *l, spectrum (*of)(const void *, const wavelengths *))
{
    enum { PASSES = 64 };
    double sum = 0;
    for (int i = 0; i < PASSES; i++) {
        wavelengths w = wavelengths_at(((float)i + 0.5f) / PASSES);
        float xyz[3];
        spectrum_to_xyz(&w, of(l->self, &w), xyz);
        sum += (double)xyz[1];
    }
    return sum / PASSES;
}

static void check_power(const char *kind, params *p, bool on_square, double expected)
{
    shape_place at = {.to_world = transform_identity()};
    lamp a = make_lamp(kind, p, on_square ? unit_square(&at) : NULL);
    g_assert_cmpfloat(fabs(luminance(a.l, a.l->kind->power) / expected - 1), <, 2e-3);
    clear_lamp(&a);
    params_free(p);
}

/* Scale 1 has Y = 1; power is the light's Y over all directions; rgb is a factor. */
static void test_scales(void)
{
    const float rgb[3] = {5, 5, 5}, kelvin = 3200;
    check_power("point", numbers_of("scale", 2.0, NULL), false, 8 * G_PI);
    check_power("point", numbers_of("power", 7.0, NULL), false, 7);
    check_power("point", numbers_of("power", 7.0, "scale", 2.0, NULL), false, 14);
    check_power("spot", numbers_of("power", 7.0, "coneangle", 20.0, NULL), false, 7);
    check_power("diffuse", numbers_of("power", 7.0, NULL), true, 7);
    check_power("diffuse", numbers_of("scale", 2.0, NULL), true, 8 * G_PI);
    check_power("distant", numbers_of("illuminance", 7.0, NULL), false, 7 * 9 * G_PI);
    check_power("infinite", numbers_of("illuminance", 7.0, NULL), false, 7 * 36 * G_PI);
    params *p = numbers_of("scale", 1.0, NULL);
    params_add_numbers(p, here, PARAM_RGB, "I", rgb, 3, NULL);
    check_power("point", p, false, 20 * G_PI);
    p = numbers_of("scale", 1.0, NULL);
    params_add_numbers(p, here, PARAM_BLACKBODY, "I", &kelvin, 1, NULL);
    check_power("point", p, false, 4 * G_PI);
}

/* ---- Bad input ---- */

static void expect_error(const char *kind, params *p, shape *on, const char *text)
{
    transform identity = transform_identity();
    GError *error = NULL;
    g_assert_null(light_new(NULL, kind, p, &identity, on, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, "shapes.pbrt:7:3: "));
    g_assert_nonnull(strstr(error->message, text));
    g_error_free(error);
    params_free(p);
    shape_free(on);
}

static void test_bad_input_is_named(void)
{
    shape_place at = {.to_world = transform_identity()};
    expect_error("sun", numbers_of(NULL, NULL), NULL,
                 "expected a light source of kind point, spot, distant, goniometric, "
                 "projection, infinite, found 'sun'");
    expect_error("diffuse", numbers_of(NULL, NULL), NULL, "expected a light source");
    expect_error("point", numbers_of(NULL, NULL), unit_square(&at),
                 "expected an area light of kind diffuse, found 'point'");
    expect_error("point", numbers_of("scale", -1.0, NULL), NULL, "scale");
    expect_error("point", numbers_of("power", 0.0, NULL), NULL, "power");
    expect_error("point", numbers_of("intensity", 1.0, NULL), NULL, "intensity");
    expect_error("spot", numbers_of("coneangle", 0.0, NULL), NULL, "coneangle");
    expect_error("spot", numbers_of("conedeltaangle", 40.0, NULL), NULL, "coneangle");
    params *p = params_new(here, "/", color_space_srgb());
    add_point(p, "to", 0, 0, 0);
    expect_error("distant", p, NULL, "must differ");
    p = params_new(here, "/", color_space_srgb());
    add_point(p, "portal", 0, 0, 0);
    expect_error("infinite", p, NULL, "'portal'");
    static const float flat[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
    g_autoptr(params) line = params_new(here, "/", color_space_srgb());
    params_add_numbers(line, here, PARAM_POINT3, "P", flat, 9, NULL);
    expect_error("diffuse", numbers_of(NULL, NULL),
                 shape_new("trianglemesh", line, &at, NULL), "must have an area");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/light/flux/three-ways", test_three_ways_to_one_flux);
    g_test_add_func("/light/flux/power", test_mean_flux_is_power);
    g_test_add_func("/light/flux/spot", test_spot_power_by_quadrature);
    g_test_add_func("/light/directions/emitted", test_emitted_directions);
    g_test_add_func("/light/directions/sampled", test_sampled_directions);
    g_test_add_func("/light/irradiance/simple", test_irradiance_of_point_spot_and_sky);
    g_test_add_func("/light/irradiance/sphere", test_irradiance_of_sphere);
    g_test_add_func("/light/irradiance/quad", test_irradiance_of_quad);
    g_test_add_func("/light/sides", test_sides);
    g_test_add_func("/light/scales", test_scales);
    g_test_add_func("/light/bad/input", test_bad_input_is_named);
    return g_test_run();
}
