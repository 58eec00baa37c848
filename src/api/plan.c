#include "nephroid/nephroid.h"

static const char *const class_names[NEPH_N_PHOTON_CLASSES] = {"direct", "indirect",
                                                               "caustic"};

static void put_photons(GString *out, const NephPlan *plan)
{
    bool any = false;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        if (plan->photons[c] == 0)
            continue;
        g_string_append_printf(out, "%-12s%-9s %12" G_GUINT64_FORMAT " a pass",
                               any ? "" : "photons", class_names[c], plan->photons[c]);
        if (plan->guided_classes[c])
            g_string_append(out, ", guided");
        if (plan->radius[c] > 0.0)
            g_string_append_printf(out, ", radius %.5g m at first", plan->radius[c]);
        g_string_append_c(out, '\n');
        any = true;
    }
    g_string_append_printf(out, "%s", any ? "" : "photons     none\n");
    if (any)
        g_string_append_printf(out, "%-12s%s\n", "radius",
                               plan->radius_is_set
                                   ? "as set"
                                   : "from how dense trial photons lie, place by place");
}

static void put_ways(GString *out, const NephPlan *plan)
{
    if (plan->photons[NEPH_PHOTON_CAUSTIC] > 0)
        g_string_append_printf(out, "%-12s%g of the blurred ones\n", "gathers",
                               plan->blurred_gathers);
    if (plan->discs > 0.0)
        g_string_append_printf(out, "%-12sof caustics with paths, by discs of %.4g m2\n",
                               "share", plan->discs);
    if (plan->spots > 0.0)
        g_string_append_printf(out, "%-12s looked at with probability %g\n",
                               "bright spots", plan->spots);
    else
        g_string_append_printf(out, "%-12s not looked at\n", "bright spots");
    g_string_append_printf(out, "%-12s%d of the shutter's time\n", "slices",
                           plan->time_slices);
}

static void put_trials(GString *out, const NephPlan *plan)
{
    if (plan->n_trials > 0)
        g_string_append_printf(out, "%-18s %27s %27s\n", "trials", "without: var. x rays",
                               "with: var. x rays");
    for (int i = 0; i < plan->n_trials; i++) {
        const NephPlanTrial *t = &plan->trials[i];
        g_string_append_printf(out, "  %-16s %14.5g x %10.5g %14.5g x %10.5g  %s\n",
                               t->what, t->variance_without, t->rays_without,
                               t->variance_with, t->rays_with,
                               t->taken ? "taken" : "left");
    }
}

char *neph_plan_text(const NephPlan *plan)
{
    GString *out = g_string_new(NULL);
    g_string_append_printf(out, "%-12s%s\n", "plan", plan->integrator);
    put_photons(out, plan);
    put_ways(out, plan);
    put_trials(out, plan);
    if (plan->work > 0.0)
        g_string_append_printf(out, "%-12s%.0f rays of about %.0f asked for\n",
                               "planning", plan->planning, plan->work);
    return g_string_free(out, FALSE);
}
