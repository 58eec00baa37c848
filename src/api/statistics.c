#include "nephroid/nephroid.h"

#include "base/json.h"

#include <math.h>

static const char *const class_names[NEPH_N_PHOTON_CLASSES] = {"direct", "indirect",
                                                               "caustic"};

static const char *const stop_words[] = {[NEPH_GOES_ON] = "nothing",
                                         [NEPH_PASSES_DONE] = "passes",
                                         [NEPH_TIME_UP] = "time",
                                         [NEPH_NOISE_REACHED] = "noise",
                                         [NEPH_CANCELLED] = "request"};

static void put_times_json(json *j, const NephStatistics *s)
{
    json_object_begin(j, "time");
    json_number(j, "total", s->time_total);
    json_number(j, "prepare", s->time_prepare);
    json_number(j, "trace", s->time_trace);
    json_number(j, "build", s->time_build);
    json_number(j, "gather", s->time_gather);
    json_number(j, "camera", s->time_camera);
    json_object_end(j);
}

static void put_photons_json(json *j, const NephStatistics *s)
{
    json_object_begin(j, "photons");
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        json_object_begin(j, class_names[c]);
        json_count(j, "emitted", s->emitted[c]);
        json_count(j, "stored", s->stored[c]);
        json_number(j, "radius", s->radius[c]);
        json_object_end(j);
    }
    json_object_end(j);
}

static char *statistics_json(const NephStatistics *s)
{
    json j = {0};
    json_object_begin(&j, NULL);
    json_integer(&j, "passes", s->passes);
    json_number(&j, "part", s->part);
    json_string(&j, "stopped_by", stop_words[s->stopped_by]);
    json_number(&j, "noise", s->noise);
    put_times_json(&j, s);
    json_object_begin(&j, "rays");
    json_count(&j, "photon", s->photon_rays);
    json_count(&j, "camera", s->camera_rays);
    json_count(&j, "shadow", s->shadow_rays);
    json_object_end(&j);
    put_photons_json(&j, s);
    json_object_begin(&j, "memory");
    json_count(&j, "peak", s->memory_peak);
    json_count(&j, "photons", s->memory_photons);
    json_object_end(&j);
    json_count(&j, "not_finite", s->n_not_finite);
    json_bool(&j, "left_noisy", s->left_noisy);
    json_bool(&j, "short_of_memory", s->short_of_memory);
    json_object_end(&j);
    return json_finish(&j);
}

static void put_time(GString *out, const char *label, double seconds, double total)
{
    g_string_append_printf(out, "  %-10s %12.3f s", label, seconds);
    if (total > 0.0)
        g_string_append_printf(out, "  %5.1f %%", 100.0 * seconds / total);
    g_string_append_c(out, '\n');
}

static void put_rays(GString *out, const char *label, uint64_t n, double seconds)
{
    g_string_append_printf(out, "  %-10s %12" G_GUINT64_FORMAT, label, n);
    if (seconds > 0.0 && n > 0)
        g_string_append_printf(out, "    %7.3f M/s", 1e-6 * (double)n / seconds);
    g_string_append_c(out, '\n');
}

static void put_photons(GString *out, const NephStatistics *s)
{
    g_string_append_printf(out, "photons    %14s %14s %14s\n", "emitted", "stored",
                           "radius");
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        g_string_append_printf(out, "  %-8s %14" G_GUINT64_FORMAT " %14" G_GUINT64_FORMAT,
                               class_names[c], s->emitted[c], s->stored[c]);
        if (s->radius[c] > 0.0)
            g_string_append_printf(out, " %12.5g m\n", s->radius[c]);
        else
            g_string_append_printf(out, " %14s\n", "-");
    }
}

static char *statistics_table(const NephStatistics *s)
{
    const double mebi = 1024.0 * 1024.0;
    GString *out = g_string_new(NULL);
    g_string_append_printf(out, "passes       %12" G_GINT64_FORMAT "    stopped by %s\n",
                           s->passes, stop_words[s->stopped_by]);
    if (isfinite(s->noise))
        g_string_append_printf(out, "noise        %12.3g %%  of the light\n",
                               100.0 * s->noise);
    g_string_append_printf(out, "time         %12.3f s\n", s->time_total);
    put_time(out, "prepare", s->time_prepare, s->time_total);
    put_time(out, "trace", s->time_trace, s->time_total);
    put_time(out, "build", s->time_build, s->time_total);
    put_time(out, "camera", s->time_camera, s->time_total);
    put_time(out, "  gather", s->time_gather, s->time_total);
    g_string_append(out, "rays\n");
    put_rays(out, "photon", s->photon_rays, s->time_trace);
    put_rays(out, "camera", s->camera_rays, s->time_camera);
    put_rays(out, "shadow", s->shadow_rays, 0.0);
    put_photons(out, s);
    g_string_append_printf(out, "memory       %12.1f MiB at its peak, photons %.1f MiB\n",
                           (double)s->memory_peak / mebi,
                           (double)s->memory_photons / mebi);
    if (s->n_not_finite)
        g_string_append_printf(
            out, "dropped      %12" G_GUINT64_FORMAT " samples that were not finite\n",
            s->n_not_finite);
    else
        g_string_append(out, "dropped                 0 samples\n");
    return g_string_free(out, FALSE);
}

char *neph_statistics_text(const NephStatistics *s, bool as_json)
{
    return as_json ? statistics_json(s) : statistics_table(s);
}
