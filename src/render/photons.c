#include "render/photons.h"

#include "base/memory.h"
#include "render/plan.h"

static const char *const class_names[N_PHOTON_CLASSES] = {"direct", "indirect",
                                                          "caustic"};

/* What a render with these settings plans, and its pass 0. */
static bool plan_photons(render_photons *p, const view *v, const settings *how,
                         const cancel_flag *cancel, GError **error)
{
    p->plan = transport_plan_of(v, how);
    p->sender = transport_find(how->integrator)->photons;
    p->w = scene_wavelengths(v->scene, how, 0);
    if (!transport_plan_prepare(&p->plan, cancel, error))
        return false;
    p->first_plan = render_first_plan(&p->plan);
    p->pass = p->sender ? p->sender->open(&p->first_plan, 0) : NULL;
    p->n_wholes = p->sender ? p->sender->n_wholes(p->pass) : 1;
    return true;
}

static uint64_t n_emitted(const render_photons *p, photon_class c)
{
    return p->sender ? p->sender->count(p->pass, c) : 0;
}

static bool trace_class(render_photons *p, photon_class c, transport_counts *counts,
                        const cancel_flag *cancel, GError **error)
{
    trace_result result = {0};
    bool ok = n_emitted(p, c) == 0 ||
              p->sender->trace(p->pass, c, cancel, counts, &result, error);
    p->stores[c] = result.photons;
    p->in_media[c] = result.in_media;
    return ok;
}

static void note(render_photons *p, const transport_counts *counts)
{
    render_statistics *log = &p->statistics;
    log->time_trace = log->time_total = counts->time_trace;
    log->photon_rays = counts->photon_rays;
    log->n_not_finite = counts->n_not_finite;
    log->memory_peak = memory_peak();
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        log->emitted[c] = counts->emitted[c];
        log->stored[c] = counts->stored[c];
        log->radius[c] = counts->radius[c];
        log->memory_photons +=
            photon_store_bytes(&p->stores[c]) + photon_store_bytes(&p->in_media[c]);
    }
}

render_photons *render_trace_photons(const view *v, const settings *how,
                                     const cancel_flag *cancel, GError **error)
{
    g_autoptr(render_photons) p = g_aligned_alloc0(1, sizeof *p, 64);
    transport_counts counts = {0};
    bool ok = plan_photons(p, v, how, cancel, error);
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
        ok = trace_class(p, (photon_class)c, &counts, cancel, error);
    note(p, &counts);
    return ok ? g_steal_pointer(&p) : NULL;
}

size_t render_photons_count(const render_photons *p, photon_class c)
{
    return p->stores[c].n + p->in_media[c].n;
}

photon render_photons_get(const render_photons *p, photon_class c, size_t i)
{
    size_t n = p->stores[c].n;
    return i < n ? photon_store_get(&p->stores[c], i)
                 : photon_store_get(&p->in_media[c], i - n);
}

void render_photons_tell(const render_photons *p, photon_class c, uint64_t i,
                         photon_listener tell, void *data)
{
    p->sender->tell(p->pass, c, i, tell, data);
}

void render_photons_free(render_photons *p)
{
    if (!p)
        return;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        photon_store_clear(&p->stores[c]);
        photon_store_clear(&p->in_media[c]);
        big_free(p->origins[c]);
    }
    if (p->pass)
        p->sender->close(p->pass);
    transport_plan_clear(&p->plan);
    g_aligned_free(p);
}

/* ---- Origins ---- */

enum { FOLLOW_CHUNK = 4096 };

/* Where photons came from, in the order of their stores. */
typedef struct origin_lists {
    GArray *on_surfaces, *in_media; /* of photon_origin */
} origin_lists;

typedef struct follow_loop {
    const render_photons *photons;
    photon_class c;
    origin_lists *found; /* one a chunk; of NULL where it was not begun */
} follow_loop;

/* A path on its way. */
typedef struct followed {
    origin_lists found;
    uint32_t bounces;
} followed;

/* Stores exactly what photon_trace would have: those that are finite. */
static void note_origin(const photon_event *event, void *data)
{
    followed *f = data;
    if (event->kind == PHOTON_SCATTERED)
        f->bounces++;
    if (event->kind != PHOTON_STORED || !spectrum_is_finite(event->flux))
        return;
    const vec3 wi = -event->direction;
    const photon_origin origin = {
        (uint32_t)event->index, f->bounces, {wi[0], wi[1], wi[2]}};
    bool on_surface = event->hit->shape != NO_INDEX;
    g_array_append_val(on_surface ? f->found.on_surfaces : f->found.in_media, origin);
}

static void follow_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const follow_loop *loop = data;
    origin_lists found = {g_array_new(FALSE, FALSE, sizeof(photon_origin)),
                          g_array_new(FALSE, FALSE, sizeof(photon_origin))};
    for (size_t i = begin; i < end; i++) {
        followed f = {found, 0};
        render_photons_tell(loop->photons, loop->c, i, note_origin, &f);
    }
    loop->found[begin / FOLLOW_CHUNK] = found;
}

/* Puts a chunk's list at the place `at` of n, and frees it. @return the next place */
static size_t take_origins(photon_origin *to, size_t at, size_t n, GArray *found)
{
    size_t some = MIN(found->len, n - at);
    for (size_t k = 0; k < some; k++)
        to[at + k] = g_array_index(found, photon_origin, k);
    g_array_unref(found);
    return at + some;
}

/* Puts the chunks behind one another, what is in media behind all that is on surfaces. */
static void join_origins(const render_photons *p, photon_class c, origin_lists *found,
                         size_t n_chunks)
{
    size_t on_surfaces = 0, in_media = p->stores[c].n;
    for (size_t i = 0; i < n_chunks; i++) {
        if (!found[i].on_surfaces)
            continue;
        on_surfaces = take_origins(p->origins[c], on_surfaces, p->stores[c].n,
                                   found[i].on_surfaces);
        in_media = take_origins(p->origins[c], in_media, render_photons_count(p, c),
                                found[i].in_media);
    }
}

static bool follow_class(render_photons *p, photon_class c, const cancel_flag *cancel,
                         GError **error)
{
    size_t n = render_photons_count(p, c), n_paths = (size_t)n_emitted(p, c);
    follow_loop loop = {.photons = p, .c = c};
    size_t n_chunks = (n_paths + FOLLOW_CHUNK - 1) / FOLLOW_CHUNK;
    p->origins[c] = big_alloc(MAX(n, 1), sizeof(photon_origin), "photon origins", error);
    if (!p->origins[c])
        return false;
    loop.found = g_new0(origin_lists, n_chunks);
    bool done = parallel_for(n_paths, FOLLOW_CHUNK, (unsigned)p->plan.how.threads, cancel,
                             follow_chunk, &loop);
    join_origins(p, c, loop.found, n_chunks);
    g_free(loop.found);
    if (!done) {
        big_free(p->origins[c]);
        p->origins[c] = NULL;
        error_set(error, ERROR_CANCELLED, "cancelled");
    }
    return done;
}

bool render_photons_follow(render_photons *p, const cancel_flag *cancel, GError **error)
{
    bool ok = true;
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
        if (!p->origins[c])
            ok = follow_class(p, (photon_class)c, cancel, error);
    return ok;
}

/* ---- The event log ---- */

typedef struct event_log {
    const scene *scene;
    const wavelengths *w;
    photon_class photon_class;
    void (*write)(const char *line, void *data);
    void *data;
} event_log;

static char *surface_name(const event_log *log, const photon_event *event)
{
    if (!event->hit)
        return event->kind == PHOTON_LEFT
                   ? g_strdup("out of the scene")
                   : g_strdup_printf("light %d (%s)", event->light,
                                     scene_light(log->scene, event->light)->kind->name);
    if (event->hit->shape == NO_INDEX)
        return g_strdup_printf(
            "medium %s", scene_medium(log->scene, event->hit->media.participating)->name);
    const shape *on = log->scene->shapes->pdata[event->hit->shape];
    const material *m = event->hit->material == NO_INDEX
                            ? NULL
                            : log->scene->materials->pdata[event->hit->material];
    return g_strdup_printf("shape %d (%s, %s)", event->hit->shape, on->kind->name,
                           !m        ? "interface"
                           : m->name ? m->name
                                     : m->kind->name);
}

static char *what_happened(const photon_event *event)
{
    static const char *const words[] = {
        [PHOTON_EMITTED] = "emitted",   [PHOTON_STORED] = "stored",
        [PHOTON_ABSORBED] = "absorbed", [PHOTON_ENDED] = "ended",
        [PHOTON_LEFT] = "left",
    };
    if (event->kind != PHOTON_SCATTERED)
        return g_strdup(words[event->kind]);
    if (event->hit->shape == NO_INDEX)
        return g_strdup("scattered");
    const char *lobe = event->lobe & LOBE_SPECULAR ? "specular"
                       : event->lobe & LOBE_GLOSSY ? "glossy"
                                                   : "diffuse";
    const char *side = event->lobe & LOBE_TRANSMISSION ? "transmitted" : "reflected";
    return g_strdup_printf("%s %s", lobe, side);
}

static void tell_event(const photon_event *event, void *data)
{
    const event_log *log = data;
    g_autofree char *surface = surface_name(log, event);
    g_autofree char *what = what_happened(event);
    float xyz[3], rgb[3];
    spectrum_to_xyz(log->w, event->flux, xyz);
    color_space_from_xyz(color_space_srgb(), xyz, rgb);
    g_autofree char *line = g_strdup_printf(
        "%s %" G_GUINT64_FORMAT
        ": at (%.5g %.5g %.5g) on %s: %s, flux (%.4g %.4g %.4g) W, "
        "going (%.4f %.4f %.4f)",
        class_names[log->photon_class], event->index, (double)event->p[0],
        (double)event->p[1], (double)event->p[2], surface, what, (double)rgb[0],
        (double)rgb[1], (double)rgb[2], (double)event->direction[0],
        (double)event->direction[1], (double)event->direction[2]);
    log->write(line, log->data);
}

bool render_photon_event_log(const view *v, const settings *how, size_t n,
                             void (*write)(const char *line, void *data), void *data,
                             GError **error)
{
    g_autoptr(render_photons) p = g_aligned_alloc0(1, sizeof *p, 64);
    if (!plan_photons(p, v, how, NULL, error))
        return false;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        event_log log = {v->scene, &p->w, (photon_class)c, write, data};
        for (size_t i = 0; i < MIN(n, n_emitted(p, (photon_class)c)); i++)
            render_photons_tell(p, (photon_class)c, i, tell_event, &log);
    }
    return true;
}
