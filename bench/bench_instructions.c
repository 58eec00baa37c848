/*
 * Small fixed pieces of work, of one thread, for instructions.py to count the
 * instructions of: all that happens within guarded().
 *
 *   bench_instructions WORK SCENE      WORK: photons, map, or an integrator
 */
#include "format/format.h"
#include "photon/photon_map.h"
#include "photon/trace/trace.h"
#include "render/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PHOTONS = 4000, SIDE = 24, NEAREST = 50 };

void guarded(const view *v, const char *work);

static void give_up(const char *what)
{
    fprintf(stderr, "bench_instructions: %s\n", what);
    exit(3);
}

static trace_result photons(const scene *s)
{
    const trace_task task = {.scene = s,
                             .how = &s->settings,
                             .w = wavelengths_for_pass(1, 0),
                             .photon_class = PHOTON_INDIRECT,
                             .n_photons = PHOTONS};
    trace_result result;
    if (!photon_trace(&task, false, &result, NULL))
        give_up("the photons can not be traced");
    return result;
}

/* Photons, built and asked for both ways at their own places. */
static void map(const scene *s)
{
    const float radius = 0.05f * s->radius;
    trace_result of = photons(s);
    photon_map *m =
        photon_map_build(MAP_GRID, &of.photons, radius, (workers){.threads = 1}, NULL);
    point_hits hits = {0};
    if (!m)
        give_up("the map can not be built");
    const photon_store *store = photon_map_store(m);
    for (size_t i = 0; i < store->n; i++) {
        vec3 p = photon_store_get(store, i).p;
        photon_map_within(m, p, radius, NULL, &hits);
        photon_map_nearest(m, p, NEAREST, INFINITY, NULL, &hits);
    }
    point_hits_clear(&hits);
    photon_map_free(m);
    trace_result_clear(&of);
}

static void picture(const view *v, const char *integrator)
{
    settings how = v->scene->settings;
    if (!settings_set(&how, "integrator", integrator, NULL))
        give_up("no such work");
    how.passes = how.spp = how.threads = 1;
    how.photons = PHOTONS;
    g_autoptr(render) r = render_new(v, &how, NULL);
    if (!r || !render_run(r, NULL, NULL, NULL))
        give_up("the scene can not be rendered");
}

__attribute__((noinline)) void guarded(const view *v, const char *work)
{
    if (strcmp(work, "photons") == 0) {
        trace_result of = photons(v->scene);
        trace_result_clear(&of);
    } else if (strcmp(work, "map") == 0) {
        map(v->scene);
    } else {
        picture(v, work);
    }
}

int main(int argc, char **argv)
{
    const load_options how = {.threads = 1};
    g_autoptr(view) v = argc == 3 ? format_load_view(argv[2], &how, NULL) : NULL;
    if (!v)
        give_up("expected work and a scene");
    v->owned->settings.threads = 1;
    view_resize(v, SIDE, SIDE);
    guarded(v, argv[1]);
    return 0;
}
