#include "panels/numbers_panel.h"

#include "panels/photon_panel.h"
#include "panels/status.h"
#include "widgets/widgets.h"

#include <math.h>

enum { MOST_NUMBERS = 32, MOST_DECISIONS = 16 };

typedef char *(*number_text)(const NephStatistics *s, const photon_frame *frame);

/* One line: under which heading, its name, how it is said. */
typedef struct number {
    const char *group, *name;
    number_text text;
} number;

struct numbers_panel {
    GtkWidget *root;
    GtkWidget *values[MOST_NUMBERS], *decisions[MOST_DECISIONS];
};

static char *seconds(double t)
{
    return t < 10.0 ? g_strdup_printf("%.3f s", t) : status_duration(t);
}

static char *count(guint64 n, double time)
{
    char *text = count_text(n);
    if (n < 1000 || !(time > 0.0))
        return text;
    char *with_rate = g_strdup_printf("%s · %.2f M/s", text, 1e-6 * (double)n / time);
    g_free(text);
    return with_rate;
}

#define TIME(name, field)                                                                \
    static char *name(const NephStatistics *s, const photon_frame *frame)                \
    {                                                                                    \
        (void)frame;                                                                     \
        return seconds(s->field);                                                        \
    }
TIME(total, time_total)
TIME(prepare, time_prepare)
TIME(photon_trace, time_trace)
TIME(build, time_build)
TIME(gather, time_gather)
TIME(look, time_camera)
#undef TIME

#define CLASS(name, c)                                                                   \
    static char *name(const NephStatistics *s, const photon_frame *frame)                \
    {                                                                                    \
        (void)frame;                                                                     \
        return photon_share_text(s, c);                                                  \
    }
CLASS(direct, NEPH_PHOTON_DIRECT)
CLASS(indirect, NEPH_PHOTON_INDIRECT)
CLASS(caustic, NEPH_PHOTON_CAUSTIC)
#undef CLASS

static char *passes(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return g_strdup_printf("%" G_GINT64_FORMAT, s->passes);
}

static char *noise(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return isfinite(s->noise) ? g_strdup_printf("%.3g %%", 100.0 * s->noise)
                              : g_strdup("–");
}

static char *photon_rays(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return count(s->photon_rays, s->time_trace);
}

static char *camera_rays(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return count(s->camera_rays, s->time_camera);
}

static char *shadow_rays(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return count(s->shadow_rays, s->time_camera);
}

static char *stored(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return count(s->stored[0] + s->stored[1] + s->stored[2], 0.0);
}

static char *emitted(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return count(s->emitted[0] + s->emitted[1] + s->emitted[2], 0.0);
}

static char *peak(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return g_format_size_full(s->memory_peak, G_FORMAT_SIZE_IEC_UNITS);
}

static char *photon_memory(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return g_format_size_full(s->memory_photons, G_FORMAT_SIZE_IEC_UNITS);
}

static char *dropped(const NephStatistics *s, const photon_frame *frame)
{
    (void)frame;
    return count(s->n_not_finite, 0.0);
}

static char *frame_text(const NephStatistics *s, const photon_frame *frame)
{
    (void)s;
    return photon_frame_text(frame);
}

static const number numbers[] = {
    {"Render", "Passes", passes},
    {"Render", "Noise", noise},
    {"Render", "Samples dropped, not finite", dropped},
    {"Time", "Render time", total},
    {"Time", "Preparation", prepare},
    {"Time", "Photon trace time", photon_trace},
    {"Time", "Map build time", build},
    {"Time", "Camera trace time", look},
    {"Time", "of that, gather time", gather},
    {"Time", "Photon view, one frame", frame_text},
    {"Rays", "Photon rays traced", photon_rays},
    {"Rays", "Camera rays", camera_rays},
    {"Rays", "Shadow rays", shadow_rays},
    {"Photons", "Emitted", emitted},
    {"Photons", "Stored", stored},
    {"Photons", "Direct map", direct},
    {"Photons", "Indirect map", indirect},
    {"Photons", "Caustic map", caustic},
    {"Memory", "Photons", photon_memory},
    {"Memory", "Whole program, at most", peak},
};

G_STATIC_ASSERT(G_N_ELEMENTS(numbers) <= MOST_NUMBERS);

/* ---- The plan ---- */

static char *photons_a_pass(const NephPlan *plan)
{
    return count_text(plan->photons[0] + plan->photons[1] + plan->photons[2]);
}

static char *first_radius(const NephPlan *plan)
{
    double caustic = plan->radius[NEPH_PHOTON_CAUSTIC];
    double indirect = plan->radius[NEPH_PHOTON_INDIRECT];
    double radius = indirect > 0.0 ? indirect : caustic;
    if (!(radius > 0.0))
        return g_strdup("–");
    return g_strdup_printf("%.3g m, %s", radius,
                           plan->radius_is_set ? "as set" : "measured");
}

static char *emission(const NephPlan *plan)
{
    bool sends = false;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        sends |= plan->photons[c] > 0;
    return g_strdup(!sends ? "–" : plan->guided ? "guided" : "not guided");
}

static char *spots(const NephPlan *plan)
{
    return plan->spots > 0.0 ? g_strdup_printf("with probability %.3g", plan->spots)
                             : g_strdup("no");
}

static char *slices(const NephPlan *plan)
{
    return g_strdup_printf("%d", plan->time_slices);
}

static char *cost(const NephPlan *plan)
{
    return plan->work > 0.0 ? g_strdup_printf("%.2g %% of the rays",
                                              100.0 * plan->planning / plan->work)
                            : g_strdup("nothing");
}

static const struct {
    const char *name;
    char *(*text)(const NephPlan *plan);
} decisions[] = {
    {"Photons a pass", photons_a_pass}, {"First radius", first_radius},
    {"Caustic emission", emission},     {"Bright spots looked at", spots},
    {"Slices of time", slices},         {"Planning", cost},
};

G_STATIC_ASSERT(G_N_ELEMENTS(decisions) <= MOST_DECISIONS);

static void add_decisions(numbers_panel *p, GtkWidget *content)
{
    GtkWidget *list;
    gtk_box_append(GTK_BOX(content), group_make("Plan", &list));
    for (size_t i = 0; i < G_N_ELEMENTS(decisions); i++)
        p->decisions[i] = value_row_add(list, decisions[i].name);
}

void numbers_panel_show_plan(numbers_panel *p, const NephPlan *plan)
{
    for (size_t i = 0; i < G_N_ELEMENTS(decisions); i++) {
        g_autofree char *text =
            plan->integrator ? decisions[i].text(plan) : g_strdup("–");
        gtk_label_set_text(GTK_LABEL(p->decisions[i]), text);
    }
}

numbers_panel *numbers_panel_new(void)
{
    numbers_panel *p = g_new0(numbers_panel, 1);
    GtkWidget *content, *list = NULL;
    const char *group = NULL;
    p->root = page_make(&content);
    for (size_t i = 0; i < G_N_ELEMENTS(numbers); i++) {
        if (g_strcmp0(group, numbers[i].group) != 0)
            gtk_box_append(GTK_BOX(content), group_make(numbers[i].group, &list));
        group = numbers[i].group;
        p->values[i] = value_row_add(list, numbers[i].name);
    }
    add_decisions(p, content);
    return p;
}

void numbers_panel_free(numbers_panel *p)
{
    g_free(p);
}

GtkWidget *numbers_panel_widget(numbers_panel *p)
{
    return p->root;
}

void numbers_panel_show(numbers_panel *p, const NephStatistics *s,
                        const photon_frame *frame)
{
    for (size_t i = 0; i < G_N_ELEMENTS(numbers); i++) {
        g_autofree char *text = numbers[i].text(s, frame);
        gtk_label_set_text(GTK_LABEL(p->values[i]), text);
    }
}
