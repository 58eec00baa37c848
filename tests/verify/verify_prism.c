/*
 * A prism takes white light apart: every wavelength leaves where Snell's law sends it, by
 * the index that the maker's Sellmeier coefficients give, and nothing is lost on the way.
 *
 *            apex        A beam thinner than a hair comes from the left, upward, through
 *            /  \        two faces of 60 degrees, and lands on a ball around it all. Each
 *     beam  /    \       photon that glass has dispersed has one wavelength left, so
 * where ──►/──────\─►    it goes can be told from what it is.
 *         /________\     .
 */
#include "photon/trace/trace.h"
#include "scene_text.h"

/* Sellmeier coefficients, µm² (Schott, optical glass data sheets). */
typedef struct glass {
    const char *name, *parameter;
    double b[3], c[3];
    double incidence; /* near that of least deviation, rad */
} glass;

static const glass glasses[] = {
    {"N-BK7",
     "\"spectrum eta\" \"glass-BK7\"",
     {1.03961212, 0.231792344, 1.01046945},
     {0.00600069867, 0.0200179144, 103.560653},
     0.86},
    {"N-SF11",
     "\"spectrum eta\" \"glass-N-SF11\"",
     {1.73759695, 0.313747346, 1.89878101},
     {0.013188707, 0.0623068142, 155.23629},
     1.10},
};

static double index_at(const glass *g, double nm)
{
    double l2 = nm * nm * 1e-6, n2 = 1;
    for (int i = 0; i < 3; i++)
        n2 += g->b[i] * l2 / (l2 - g->c[i]);
    return sqrt(n2);
}

/* Unpolarised transmittance of a face. */
static double transmitted(double sin_i, double n1, double n2)
{
    double sin_t = sin_i * n1 / n2, ci = sqrt(1 - sin_i * sin_i),
           ct = sqrt(1 - sin_t * sin_t);
    double s = (n1 * ci - n2 * ct) / (n1 * ci + n2 * ct);
    double p = (n2 * ci - n1 * ct) / (n2 * ci + n1 * ct);
    return 1 - 0.5 * (s * s + p * p);
}

/* What comes out of the second face: angle to its normal and share of the light. */
static double angle_out(const glass *g, double nm, double *share)
{
    double n = index_at(g, nm), first = sin(g->incidence) / n;
    double second = sin(G_PI / 3 - asin(first));
    *share = transmitted(sin(g->incidence), 1, n) * transmitted(second, n, 1);
    return asin(second * n);
}

/* What became of the photons of one lane. */
typedef struct wavelength_sum {
    double emitted, landed, straight; /* flux; straight: through both faces */
    double furthest;                  /* of those, from Snell's angle, rad */
} wavelength_sum;

typedef struct experiment {
    const glass *glass;
    wavelengths w;
    wavelength_sum wavelengths[N_WAVELENGTHS];
    bool mixed; /* a photon went through with more than one wavelength */
} experiment;

/* Unit normals of the faces, in the plane y = 0. */
static const vec3 face_in = {-0.8660254f, 0, 0.5f}, face_out = {0.8660254f, 0, 0.5f};

/* The last flight's angle to the second face's normal, positive downward from it. */
static double angle_of(vec3 d)
{
    vec3 along = vec3_make(0.5f, 0, -0.8660254f);
    return atan2((double)dot3(d, along), (double)dot3(d, face_out));
}

static void watch(const photon_event *event, void *data)
{
    experiment *e = data;
    bool emitted = event->kind == PHOTON_EMITTED;
    if (!emitted && event->kind != PHOTON_STORED)
        return;
    int coloured = 0;
    for (int k = 0; k < N_WAVELENGTHS; k++)
        coloured += event->flux[k] > 0;
    for (int k = 0; k < N_WAVELENGTHS; k++) {
        double flux = (double)event->flux[k], share;
        if (!(flux > 0))
            continue;
        wavelength_sum *wavelength = &e->wavelengths[k];
        *(emitted ? &wavelength->emitted : &wavelength->landed) += flux;
        double expected = angle_out(e->glass, (double)e->w.lambda[k], &share);
        double off = fabs(angle_of(event->direction) - expected);
        if (!emitted && off < 0.002) {
            wavelength->straight += flux;
            wavelength->furthest = fmax(wavelength->furthest, off);
            e->mixed |= coloured != 1;
        }
    }
}

/* The beam: from 100 m, to the middle of the first face. */
static scene *prism_of(const glass *g)
{
    vec3 along = vec3_make(0.5f, 0, 0.8660254f); /* up the first face */
    vec3 from =
        vec3_make(-0.25f, 0, 0.4330127f) +
        100.0f * ((float)cos(g->incidence) * face_in - (float)sin(g->incidence) * along);
    g_autofree char *text = g_strdup_printf(
        "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 8 \"integer "
        "yresolution\" 8\n"
        "WorldBegin LightSource \"spot\" \"point3 from\" [%.9g 0 %.9g] \"point3 to\" "
        "[-0.25 0 0.4330127] \"float coneangle\" 0.001 \"float conedeltaangle\" 0.0005\n"
        "Material \"dielectric\" %s\n"
        "Shape \"trianglemesh\" \"point3 P\" [-0.5 -1 0 0.5 -1 0 0 -1 0.8660254 -0.5 1 0 "
        "0.5 1 0 0 1 0.8660254] \"integer indices\" [0 1 2 3 5 4 0 2 5 0 5 3 2 1 4 2 4 5 "
        "0 4 1 0 3 4]\n"
        "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float "
        "radius\" 500\n",
        (double)from[0], (double)from[2], g->parameter);
    return scene_of(text);
}

static void test_prism(gconstpointer data)
{
    enum { PHOTONS = 200000 };
    experiment e = {.glass = data, .w = wavelengths_at(0.5f)};
    g_autoptr(scene) s = prism_of(e.glass);
    settings how = settings_default();
    how.class_emission[PHOTON_CAUSTIC] = EMISSION_UNIFORM;
    trace_task task = {.scene = s,
                       .how = &how,
                       .w = e.w,
                       .photon_class = PHOTON_CAUSTIC,
                       .n_photons = PHOTONS};
    for (uint64_t i = 0; i < PHOTONS; i++)
        photon_tell(&task, i, watch, &e);
    double emitted = 0, landed = 0;
    for (int k = 0; k < N_WAVELENGTHS; k++) {
        const wavelength_sum *wavelength = &e.wavelengths[k];
        double share, nm = (double)e.w.lambda[k], angle = angle_out(e.glass, nm, &share);
        g_test_message("%g nm: n %.5f, out at %.3f degrees, at most %.1g rad off; share "
                       "%.4f, Fresnel %.4f",
                       nm, index_at(e.glass, nm), angle * 180 / G_PI,
                       wavelength->furthest, wavelength->straight / wavelength->emitted,
                       share);
        g_assert_cmpfloat(wavelength->furthest, <, 3e-4);
        g_assert_cmpfloat(fabs(wavelength->straight / wavelength->emitted / share - 1), <,
                          0.035);
        emitted += wavelength->emitted;
        landed += wavelength->landed;
    }
    g_test_message("white: %g of %g", landed, emitted);
    g_assert_false(e.mixed);
    g_assert_cmpfloat(fabs(landed / emitted - 1), <, 0.005);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(glasses); i++) {
        g_autofree char *name = g_strconcat("/verify/prism/", glasses[i].name, NULL);
        g_test_add_data_func(name, &glasses[i], test_prism);
    }
    return g_test_run();
}
