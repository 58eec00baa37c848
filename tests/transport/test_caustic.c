/*
 * Caustics against the geometry of light: the nephroid and the cardioid in a mirror
 * cylinder, and the flux and focus of a glass ball.
 */
#include "photon/trace/trace.h"
#include "scene_text.h"

#define CAMERA                                                                           \
    "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 8 \"integer "           \
    "yresolution\" 8\n"

/* A cup: black floor at z = 0, a mirror cylinder of radius 1 around it. */
#define CUP                                                                              \
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"disk\" \"float radius\" "  \
    "1\n"                                                                                \
    "Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "           \
    "\"metal-Ag-k\"\n"                                                                   \
    "Shape \"cylinder\" \"float radius\" 1 \"float zmin\" 0 \"float zmax\" 0.5\n"

static trace_result caustic_photons(const scene *s, settings *how, uint64_t n)
{
    g_autoptr(caustic_casters) casters = caustic_casters_new(s, NULL);
    trace_task task = {.scene = s,
                       .how = how,
                       .w = wavelengths_at(0.5f),
                       .photon_class = PHOTON_CAUSTIC,
                       .casters = casters,
                       .n_photons = n};
    trace_result result;
    g_assert_true(photon_trace(&task, false, &result, NULL));
    return result;
}

/* A curve in the plane by its parameter. */
typedef vec2 (*plane_curve)(double t);

/* Reflections of parallel light along +x in the unit circle: one arch of the nephroid. */
static vec2 nephroid(double t)
{
    return (vec2){(float)(0.25 * (3 * cos(t) - cos(3 * t))),
                  (float)(0.25 * (3 * sin(t) - sin(3 * t)))};
}

/* Reflections of light from the point (-1, 0) of the unit circle: the cardioid, its cusp,
   at t = π, at (1/3, 0). */
static vec2 cardioid(double t)
{
    return (vec2){(float)(-(2 * cos(t) + cos(2 * t)) / 3),
                  (float)((2 * sin(t) + sin(2 * t)) / 3)};
}

static vec2 normal_of(plane_curve c, double t)
{
    vec2 a = c(t - 1e-4), b = c(t + 1e-4);
    float x = b.x - a.x, y = b.y - a.y, length = sqrtf(x * x + y * y);
    return (vec2){-y / length, x / length};
}

/* Where, along the curve's normal at t, the flux on the floor is densest: the offset of
   the fullest of bins 2/100 wide in a strip 0.1 broad. */
static double ridge_offset(const photon_store *photons, plane_curve c, double t)
{
    enum { BINS = 30 };
    const double bin = 0.01;
    double flux[BINS] = {0};
    vec2 at = c(t), n = normal_of(c, t);
    for (size_t i = 0; i < photons->n; i++) {
        float x = photons->x[i] - at.x, y = photons->y[i] - at.y;
        if (photons->z[i] > 1e-4f || fabsf(-x * n.y + y * n.x) > 0.04f)
            continue;
        int k = (int)floor((double)(x * n.x + y * n.y) / bin + 0.5 * BINS);
        if (k >= 0 && k < BINS)
            flux[k] += (double)spectrum_mean(photons->flux[i]);
    }
    int best = 0;
    for (int k = 1; k < BINS; k++)
        best = flux[k] > flux[best] ? k : best;
    return (best + 0.5 - 0.5 * BINS) * bin;
}

/* On the envelope the density has its inverse square root pole, so the fullest bin
 * touches it. */
static void check_ridge(const photon_store *photons, plane_curve c, const double *ts,
                        size_t n)
{
    for (size_t i = 0; i < n; i++) {
        double offset = ridge_offset(photons, c, ts[i]);
        g_test_message("t = %g: ridge %g from the envelope", ts[i], offset);
        g_assert_cmpfloat(fabs(offset), <, 0.025);
    }
}

static void test_nephroid(void)
{
    g_autoptr(scene) s = scene_of(
        CAMERA
        "WorldBegin LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [-2 0 1] "
        "\"point3 to\" [0 0 0]\n" CUP);
    settings how = settings_default();
    how.max_forward_bounces = 1;
    trace_result r = caustic_photons(s, &how, 400000);
    /* the cusp lies at R/2 on the side the light comes to: nephroid(0) = (0.5, 0) */
    const double ts[] = {0.35, 0.6, 0.85, -0.35, -0.6, -0.85};
    g_assert_cmpfloat(fabsf(nephroid(0).x - 0.5f), <, 1e-6f);
    check_ridge(&r.photons, nephroid, ts, G_N_ELEMENTS(ts));
    trace_result_clear(&r);
}

/* Along the axis, light once reflected reaches the cusp at R/2 and no nearer to the
 * centre. */
static void test_cusp_at_half_the_radius(void)
{
    g_autoptr(scene) s = scene_of(
        CAMERA
        "WorldBegin LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [-2 0 1] "
        "\"point3 to\" [0 0 0]\n" CUP);
    settings how = settings_default();
    how.max_forward_bounces = 1;
    trace_result r = caustic_photons(s, &how, 400000);
    double flux[40] = {0};
    for (size_t i = 0; i < r.photons.n; i++) {
        if (fabsf(r.photons.y[i]) < 0.02f && r.photons.x[i] > 0.0f &&
            r.photons.z[i] < 1e-4f)
            flux[MIN((int)(r.photons.x[i] * 40.0f), 39)] +=
                (double)spectrum_mean(r.photons.flux[i]);
    }
    int best = 0;
    for (int k = 1; k < 40; k++)
        best = flux[k] > flux[best] ? k : best;
    g_test_message("brightest at %g of the radius", (best + 0.5) / 40.0);
    g_assert_cmpfloat(fabs((best + 0.5) / 40.0 - 0.5), <, 0.04);
    trace_result_clear(&r);
}

static void test_cardioid(void)
{
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin LightSource \"point\" \"rgb I\" [1 1 1] "
                        "\"point3 from\" [-0.999 0 0.9]\n" CUP);
    settings how = settings_default();
    how.max_forward_bounces = 1;
    trace_result r = caustic_photons(s, &how, 800000);
    const double ts[] = {2.6, 2.3, 2.0, -2.6, -2.3, -2.0};
    check_ridge(&r.photons, cardioid, ts, G_N_ELEMENTS(ts));
    trace_result_clear(&r);
}

/* ---- The glass ball ---- */

static double fresnel(double cos_i, double n)
{
    double sin_t = sqrt(1 - cos_i * cos_i) / n, cos_t = sqrt(1 - sin_t * sin_t);
    double s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    double p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return 0.5 * (s * s + p * p);
}

/* Parallel light down on a ball of index n: the share of the flux on its disc that a wide
   floor under it gets by two refractions (T²) or by one reflection that goes on downward
   (R). */
static double flux_share(double n)
{
    enum { STEPS = 20000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        double theta = (i + 0.5) / STEPS * G_PI_2, weight = 2 * sin(theta) * cos(theta);
        double r = fresnel(cos(theta), n), inside = asin(sin(theta) / n);
        double through = 2 * (theta - inside) < G_PI_2 ? (1 - r) * (1 - r) : 0.0;
        double off = theta > G_PI_4 ? r : 0.0;
        sum += (through + off) * weight * G_PI_2 / STEPS;
    }
    return sum;
}

#define BALL(n)                                                                          \
    "Material \"dielectric\" \"float eta\" " #n " Shape \"sphere\" \"float radius\" 1\n"

/* The floor must be wide: what grazes the ball goes far. */
#define WIDE_FLOOR                                                                       \
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"disk\" \"float height\" "  \
    "-3 \"float radius\" 3000\n"

static void test_glass_ball_flux(void)
{
    g_autoptr(scene) s = scene_of(
        CAMERA
        "WorldBegin LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 0 1] "
        "\"point3 to\" [0 0 0]\n" BALL(1.5) WIDE_FLOOR);
    settings how = settings_default();
    how.max_forward_bounces = 2;
    how.class_emission[PHOTON_CAUSTIC] = EMISSION_SPECULAR_AREA;
    trace_result r = caustic_photons(s, &how, 200000);
    double found = 0;
    for (size_t i = 0; i < r.photons.n; i++)
        found += (double)spectrum_mean(r.photons.flux[i]);
    /* the flux on the ball's disc: power per area of the light times its area */
    wavelengths w = wavelengths_at(0.5f);
    const light *l = scene_light(s, 0);
    light_sample sample;
    g_assert_true(
        l->kind->sample(l->self, &w, vec3_make(0, 0, 0), 0, (vec2){0, 0}, &sample));
    double disc = G_PI * (double)spectrum_mean(sample.radiance);
    g_test_message("share %g, Fresnel integral %g", found / disc, flux_share(1.5));
    g_assert_cmpfloat(fabs(found / disc / flux_share(1.5) - 1.0), <, 0.005);
    trace_result_clear(&r);
}

/* The photons that pass near the axis of the lens: fitted where they come together. */
static void check_focus(double n, const char *ball)
{
    g_autofree char *text = g_strconcat(
        CAMERA
        "WorldBegin LightSource \"spot\" \"rgb I\" [1 1 1] \"point3 from\" [0 0 200] "
        "\"point3 to\" [0 0 0] \"float coneangle\" 0.02 \"float conedeltaangle\" 0.001\n",
        ball, WIDE_FLOOR, NULL);
    g_autoptr(scene) s = scene_of(text);
    settings how = settings_default();
    how.max_forward_bounces = 2;
    how.class_emission[PHOTON_CAUSTIC] = EMISSION_UNIFORM;
    trace_result r = caustic_photons(s, &how, 20000);
    /* each photon's line x + t d crosses the axis nearest at the focus: least squares in
     * z */
    double num = 0, den = 0;
    for (size_t i = 0; i < r.photons.n; i++) {
        photon p = photon_store_get(&r.photons, i);
        double slope_x = (double)(p.wi[0] / p.wi[2]),
               slope_y = (double)(p.wi[1] / p.wi[2]);
        if (slope_x * slope_x + slope_y * slope_y > 0.1)
            continue; /* reflected */
        num += slope_x * (double)p.p[0] + slope_y * (double)p.p[1];
        den += slope_x * slope_x + slope_y * slope_y;
    }
    double focus = -3.0 - num / den; /* z where Σ |x + (z+3) slope|² is least */
    double f = n / (2 * (n - 1));
    /* the lamp is 200 radii away, so the image lies a little behind the focus: 1/f = 1/a
     * + 1/b */
    double expected = -1.0 / (1.0 / f - 1.0 / 200.0);
    g_test_message("n = %g: focus at z = %g, paraxial %g", n, focus, expected);
    g_assert_cmpfloat(fabs(focus / expected - 1.0), <, 0.01);
    trace_result_clear(&r);
}

static void test_glass_ball_focus(void)
{
    check_focus(1.5, BALL(1.5));
    check_focus(1.8, BALL(1.8));
}

/* ---- Far lamps ---- */

/* What a ball of radius 5 mm at the origin is lit with, by light sampling. */
static double flux_on_ball(const scene *s)
{
    const wavelengths w = wavelengths_at(0.5f);
    const light *l = scene_light(s, 0);
    light_sample at;
    g_assert_true(l->kind->sample(l->self, &w, (vec3){0}, 0.5f, (vec2){0.5f, 0.5f}, &at));
    return (double)(spectrum_mean(at.radiance) / at.pdf) * G_PI * 0.005 * 0.005;
}

/* A lamp askew, so that no coordinate is round, and a ball of glass that bends nothing
   before a screen: the caustic's flux is what falls on the ball. False alarm by chance
   below 1e-6. */
static void check_far_lamp(double distance, const char *lamp)
{
    enum { N = 40000 };
    g_autofree char *text = g_strdup_printf(
        CAMERA "WorldBegin AttributeBegin LookAt 0 0 0  0.3 0.5 1  0 1 0 Translate 0 0 "
               "%.9g %s AttributeEnd Material \"dielectric\" \"float eta\" 1 Shape "
               "\"sphere\" \"float radius\" 0.005 Material \"diffuse\" Shape "
               "\"sphere\" \"float radius\" 0.1 \"float zmax\" 0",
        distance, lamp);
    g_autoptr(scene) s = scene_of(text);
    settings how = settings_default();
    how.max_forward_bounces = 4;
    trace_result r = caustic_photons(s, &how, N);
    double sum = 0.0, sum2 = 0.0, expected = flux_on_ball(s);
    for (size_t i = 0; i < r.photons.n; i++) {
        double flux = (double)spectrum_mean(r.photons.flux[i]);
        sum += flux;
        sum2 += flux * flux;
    }
    double error = sqrt(MAX(sum2 - sum * sum / N, 0.0));
    g_test_message("%g m: %zu photons, flux %g +- %g of what falls on the ball", distance,
                   r.photons.n, sum / expected, error / expected);
    g_assert_cmpuint(r.photons.n, >, N / 20);
    g_assert_cmpfloat(fabs(sum - expected), <, 5.0 * error + 0.001 * expected);
    trace_result_clear(&r);
}

static void test_far_lamps(void)
{
    static const double distances[] = {0.5, 40.0, 400.0, 1e4};
    for (size_t i = 0; i < G_N_ELEMENTS(distances); i++) {
        double d = distances[i];
        g_autofree char *disk =
            g_strdup_printf("Rotate 180 1 0 0 AreaLightSource \"diffuse\" Shape \"disk\" "
                            "\"float radius\" "
                            "%.9g",
                            d / 1000);
        g_autofree char *ball = g_strdup_printf(
            "AreaLightSource \"diffuse\" Shape \"sphere\" \"float radius\" %.9g",
            d / 1000);
        check_far_lamp(d, "LightSource \"point\"");
        check_far_lamp(d, "LightSource \"spot\" \"point3 to\" [0 0 -1]");
        check_far_lamp(d, disk);
        check_far_lamp(d, ball);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/caustic/nephroid", test_nephroid);
    g_test_add_func("/caustic/cusp", test_cusp_at_half_the_radius);
    g_test_add_func("/caustic/cardioid", test_cardioid);
    g_test_add_func("/caustic/ball/flux", test_glass_ball_flux);
    g_test_add_func("/caustic/ball/focus", test_glass_ball_focus);
    g_test_add_func("/caustic/far-lamps", test_far_lamps);
    return g_test_run();
}
