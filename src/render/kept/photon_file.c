#include "render/kept/photon_file.h"

#include "base/memory.h"
#include "base/output.h"
#include "render/kept/checked_file.h"
#include "render/kept/same_settings.h"
#include "transport/plan/plan_bytes.h"

#include <string.h>

enum {
    PART = 1 << 20, /* size: photons emitted for one section */
    MOST_ARRAYS = 8,
    MOST_PLAN = 1 << 28, /* size: bytes */
};

static const checked_kind kind = {"photons", "photon map", "2"};

/* What photons do not depend on, nor the plan that they were sent by. */
static const char *const free_rows[] = {
    "passes",          "time",           "noise",           "threads",
    "denoise",         "first_spp",      "camera_seed",     "gather_rays",
    "photon_map",      "direct_kernel",  "indirect_kernel", "direct_cone_k",
    "indirect_cone_k", "caustic_kernel", "caustic_cone_k",  NULL};

/* ---- Sections ---- */

typedef enum section_kind { SECTION_PLAN, SECTION_PHOTONS, SECTION_END } section_kind;

enum { ORIENTED = 1, TAGGED = 2, HOMED = 4, IN_MEDIA = 8, ALL_FLAGS = 15 };

typedef struct section {
    uint32_t kind, pass, slice, c, flags;
    uint32_t unused;
    uint64_t n; /* photons, of the plan bytes, of the end sections before it */
} section;

typedef struct store_array {
    void *data;
    size_t size; /* of an element */
} store_array;

static size_t arrays_of(const photon_store *s, store_array out[MOST_ARRAYS])
{
    size_t n = 0;
    out[n++] = (store_array){s->x, sizeof *s->x};
    out[n++] = (store_array){s->y, sizeof *s->y};
    out[n++] = (store_array){s->z, sizeof *s->z};
    out[n++] = (store_array){s->wi, sizeof *s->wi};
    out[n++] = (store_array){s->flux, sizeof *s->flux};
    if (s->oriented)
        out[n++] = (store_array){s->normal, sizeof *s->normal};
    if (s->tagged)
        out[n++] = (store_array){s->tag, sizeof *s->tag};
    if (s->homed)
        out[n++] = (store_array){s->home, sizeof *s->home};
    return n;
}

static uint32_t flags_of(const photon_store *s)
{
    return (s->oriented ? ORIENTED : 0u) | (s->tagged ? TAGGED : 0u) |
           (s->homed ? HOMED : 0u);
}

static photon_store store_of(uint32_t flags)
{
    return (photon_store){
        .oriented = flags & ORIENTED, .tagged = flags & TAGGED, .homed = flags & HOMED};
}

/* ---- Writing ---- */

typedef struct writer {
    const photon_file_order *order;
    const photon_sender *sender;
    transport_plan *plan;
    FILE *to;
    uint64_t n_sections;
    transport_counts counts;
} writer;

static void put_head(writer *w, const section *head)
{
    checked_put(w->to, head, sizeof *head);
    w->n_sections++;
}

static void put_store(writer *w, section head, const photon_store *s)
{
    store_array arrays[MOST_ARRAYS];
    size_t n = s->n > 0 ? arrays_of(s, arrays) : 0;
    if (n == 0)
        return;
    head.flags |= flags_of(s);
    head.n = s->n;
    put_head(w, &head);
    for (size_t i = 0; i < n; i++)
        checked_put(w->to, arrays[i].data, s->n * arrays[i].size);
}

static bool put_part(writer *w, const void *pass, uint32_t index, const photon_part *part,
                     GError **error)
{
    trace_result result = {0};
    if (!w->sender->trace_part(pass, part, w->order->cancel, &w->counts, &result, error))
        return false;
    section head = {.kind = SECTION_PHOTONS,
                    .pass = index,
                    .slice = (uint32_t)part->slice,
                    .c = (uint32_t)part->c};
    put_store(w, head, &result.photons);
    head.flags = IN_MEDIA;
    put_store(w, head, &result.in_media);
    trace_result_clear(&result);
    return !ferror(w->to); /* why, the end of the file tells */
}

static bool put_class(writer *w, const void *pass, uint32_t index, photon_class c,
                      GError **error)
{
    int n_slices = w->sender->n_wholes(pass);
    uint64_t each = w->sender->count(pass, c) / (uint64_t)n_slices;
    bool ok = true;
    for (int slice = 0; slice < n_slices && ok; slice++)
        for (uint64_t at = 0; at < each && ok; at += PART) {
            const photon_part part = {c, slice, at, MIN(at + PART, each)};
            ok = put_part(w, pass, index, &part, error);
        }
    return ok;
}

static bool put_pass(writer *w, uint32_t index, GError **error)
{
    void *pass = w->sender->open(w->plan, index);
    bool ok = true;
    for (int c = 0; c < N_PHOTON_CLASSES && ok; c++)
        ok = put_class(w, pass, index, (photon_class)c, error);
    w->sender->close(pass);
    return ok;
}

static void put_plan(writer *w)
{
    g_autoptr(GByteArray) bytes = g_byte_array_new();
    plan_put(w->plan, bytes);
    const section head = {.kind = SECTION_PLAN, .n = bytes->len};
    put_head(w, &head);
    checked_put(w->to, bytes->data, bytes->len);
}

static void put_header(const writer *w)
{
    const photon_file_order *order = w->order;
    const render_plan plan = render_plan_of(w->plan);
    g_autofree char *digest = render_plan_digest(&plan);
    const settings asked = transport_plan_of(order->view, order->how).how;
    GString *out = g_string_new(NULL);
    g_string_append_printf(
        out, "program %s\nscene %s\nplan %s\npasses %" G_GINT64_FORMAT "\n",
        order->who->program, order->who->scene, digest, order->n_passes);
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = settings_get(&asked, &rows[i]);
        g_string_append_printf(out, "asked %s = %s\n", rows[i].name, value);
    }
    checked_begin(w->to, &kind, out);
    g_string_free(out, TRUE);
}

static bool put_all(writer *w, GError **error)
{
    put_header(w);
    put_plan(w);
    for (uint32_t i = 0; i < (uint32_t)w->order->n_passes; i++)
        if (!put_pass(w, i, error))
            return false;
    const section end = {.kind = SECTION_END, .n = w->n_sections};
    put_head(w, &end);
    return true;
}

/* What the setting `integrator` may say here; owned by the caller. */
static char *kept_integrators(void)
{
    GString *out = g_string_new(NULL);
    for (const char *const *word = settings_find("integrator")->words; *word; word++) {
        settings how = settings_default();
        settings_set(&how, "integrator", *word, NULL);
        const photon_sender *sender = transport_find(how.integrator)->photons;
        if (sender && sender->trace_part)
            g_string_append_printf(out, "%s%s", out->len ? ", " : "", *word);
    }
    return g_string_free(out, FALSE);
}

/* Whether what it sends can be used again. */
static bool keeps_photons(const transport_plan *plan, const photon_sender *sender,
                          GError **error)
{
    const char *name = transport_find(plan->how.integrator)->name;
    uint64_t n = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += plan->n_photons[c];
    g_autofree char *others = kept_integrators();
    if (!sender || !sender->trace_part)
        error_set(error, ERROR_USAGE,
                  "integrator %s: expected one of %s, whose photons do without the "
                  "camera",
                  name, others);
    else if (n == 0)
        error_set(error, ERROR_USAGE,
                  "there is nothing to keep: integrator %s sends no photons here", name);
    else
        return true;
    return false;
}

static void note(render_statistics *st, const transport_counts *counts)
{
    *st = (render_statistics){.time_total = counts->time_trace,
                              .time_trace = counts->time_trace,
                              .photon_rays = counts->photon_rays,
                              .n_not_finite = counts->n_not_finite,
                              .memory_peak = memory_peak()};
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        st->emitted[c] = counts->emitted[c];
        st->stored[c] = counts->stored[c];
        st->radius[c] = counts->radius[c];
    }
}

/* Passes are alike: the first, too, has all its photons. Of other passes than these there
   will be no photons, however many there are. */
static bool plan_passes(writer *w, GError **error)
{
    const photon_file_order *order = w->order;
    *w->plan = transport_plan_of(order->view, order->how);
    w->plan->how.first_spp = 0;
    if (!(w->plan->how.planned_passes > 0.0))
        w->plan->how.planned_passes = (double)order->n_passes;
    w->sender = transport_find(order->how->integrator)->photons;
    return transport_plan_prepare(w->plan, order->cancel, error) &&
           keeps_photons(w->plan, w->sender, error);
}

bool photon_file_write(const photon_file_order *order, const char *path,
                       render_statistics *statistics, GError **error)
{
    writer w = {.order = order, .plan = g_aligned_alloc0(1, sizeof *w.plan, 64)};
    output *out = output_open(path, error);
    bool ok = out && plan_passes(&w, error);
    if (ok) {
        w.to = output_stream(out);
        ok = put_all(&w, error);
    }
    if (ok || (w.to && ferror(w.to)))
        ok = output_commit(g_steal_pointer(&out), error);
    output_discard(out);
    if (statistics)
        note(statistics, &w.counts);
    transport_plan_clear(w.plan);
    g_aligned_free(w.plan);
    return ok;
}

/* ---- Reading ---- */

/* A section and where its data begin. */
typedef struct place {
    section head;
    size_t at;
} place;

struct photon_file {
    checked_reader reader;
    char *program, *scene, *id;
    int64_t n_passes;
    settings asked;
    GArray *places; /* of place, in their order; the plan is the first */
};

void photon_file_free(photon_file *file)
{
    if (!file)
        return;
    checked_close(&file->reader);
    g_free(file->program);
    g_free(file->scene);
    g_free(file->id);
    if (file->places)
        g_array_unref(file->places);
    g_free(file);
}

static bool read_line(photon_file *f, char *line)
{
    char *rest = strchr(line, ' '), *value = rest ? strstr(rest, " = ") : NULL;
    if (!rest)
        return false;
    *rest++ = '\0';
    if (strcmp(line, "program") == 0 && !f->program)
        f->program = g_strdup(rest);
    else if (strcmp(line, "scene") == 0 && !f->scene)
        f->scene = g_strdup(rest);
    else if (strcmp(line, "passes") == 0)
        f->n_passes = g_ascii_strtoll(rest, NULL, 10);
    else if (strcmp(line, "asked") == 0 && value) {
        *value = '\0';
        return settings_set(&f->asked, rest, value + strlen(" = "), NULL);
    } else
        return strcmp(line, "plan") == 0;
    return true;
}

static bool read_header(photon_file *f, const char *header, GError **error)
{
    g_auto(GStrv) lines = g_strsplit(header, "\n", -1);
    f->asked = settings_default();
    f->id = g_compute_checksum_for_string(G_CHECKSUM_SHA256, header, -1);
    for (char **line = lines; *line; line++)
        if (**line && !read_line(f, *line))
            return checked_refuse_damaged(&f->reader, *line, error);
    bool is_whole =
        f->program && f->scene && f->n_passes > 0 && f->n_passes <= G_MAXINT32;
    return is_whole ||
           checked_refuse_damaged(&f->reader, "its header is not whole", error);
}

static bool is_sound(const photon_file *f, const section *head)
{
    if (head->kind == SECTION_PLAN)
        return f->places->len == 0 && head->n <= MOST_PLAN;
    return head->kind == SECTION_PHOTONS && f->places->len > 0 &&
           head->pass < f->n_passes && head->slice < MOST_TIME_SLICES &&
           head->c < N_PHOTON_CLASSES && head->flags <= ALL_FLAGS && head->n > 0 &&
           head->n <= UINT32_MAX;
}

/* Passes over the data of a section. */
static bool skip(const photon_file *f, const section *head, GError **error)
{
    store_array arrays[MOST_ARRAYS];
    const photon_store empty = store_of(head->flags);
    if (head->kind == SECTION_PLAN)
        return checked_skip(&f->reader, head->n, error);
    size_t n = arrays_of(&empty, arrays);
    for (size_t i = 0; i < n; i++)
        if (!checked_skip(&f->reader, head->n * arrays[i].size, error))
            return false;
    return true;
}

static bool read_heads(photon_file *f, GError **error)
{
    f->places = g_array_new(FALSE, FALSE, sizeof(place));
    for (;;) {
        place p;
        if (!checked_get(&f->reader, &p.head, sizeof p.head, "sections", error))
            return false;
        p.at = checked_at(&f->reader);
        if (p.head.kind == SECTION_END)
            return (p.at == f->reader.size && p.head.n == f->places->len) ||
                   checked_refuse_damaged(&f->reader, "something follows its end", error);
        if (!is_sound(f, &p.head))
            return checked_refuse_damaged(&f->reader, "a section is of no known kind",
                                          error);
        if (!skip(f, &p.head, error))
            return false;
        g_array_append_val(f->places, p);
    }
}

photon_file *photon_file_open(const char *path, GError **error)
{
    g_autoptr(photon_file) f = g_new0(photon_file, 1);
    g_autofree char *header = checked_open(&f->reader, &kind, path, error);
    if (!header || !read_header(f, header, error) || !read_heads(f, error))
        return NULL;
    if (f->places->len == 0 && !checked_refuse_damaged(&f->reader, "it is empty", error))
        return NULL;
    return g_steal_pointer(&f);
}

bool photon_file_suits(const photon_file *f, const render_identity *who,
                       const settings *asked, GError **error)
{
    if (strcmp(f->program, who->program) != 0)
        return checked_refuse(&f->reader, error,
                              "the photon map was written by %s, this is %s", f->program,
                              who->program);
    if (strcmp(f->scene, who->scene) != 0)
        return checked_refuse(&f->reader, error,
                              "the photon map is of another scene, or of files that have "
                              "changed");
    const settings_question question = {
        .now = asked, .then = &f->asked, .free_rows = free_rows, .path = f->reader.path};
    return same_settings(&question, "the photon map was made", error);
}

settings photon_file_settings(const photon_file *f)
{
    return f->asked;
}

int64_t photon_file_passes(const photon_file *f)
{
    return f->n_passes;
}

const char *photon_file_id(const photon_file *f)
{
    return f->id;
}

static bool go_to(const photon_file *f, const place *p, GError **error)
{
    return fseeko(f->reader.from, (off_t)p->at, SEEK_SET) == 0 ||
           checked_refuse_short(&f->reader, error);
}

bool photon_file_plan(photon_file *f, transport_plan *plan, GError **error)
{
    const place *p = &g_array_index(f->places, place, 0);
    const settings now = plan->how;
    size_t size = p->head.n;
    g_autofree void *data = g_malloc(size + 1);
    if (!go_to(f, p, error) || !checked_get(&f->reader, data, size, "plan", error))
        return false;
    if (!plan_get(plan, data, size, error)) {
        g_prefix_error(error, "%s: ", f->reader.path);
        return false;
    }
    take_settings_of(&plan->how, &now, free_rows);
    plan->how.first_spp = 0;
    return true;
}

/* Which photons are asked for. */
typedef struct wanted {
    uint32_t pass, slice, c;
    bool in_media;
} wanted;

static bool is_wanted(const place *p, const wanted *what)
{
    const section *head = &p->head;
    return head->kind == SECTION_PHOTONS && head->pass == what->pass &&
           head->slice == what->slice && head->c == what->c &&
           (head->flags & IN_MEDIA) == (what->in_media ? (uint32_t)IN_MEDIA : 0u);
}

/* Behind those that the store has, where there is room. */
static bool read_photons(const photon_file *f, const place *p, photon_store *store,
                         GError **error)
{
    store_array arrays[MOST_ARRAYS];
    size_t n = arrays_of(store, arrays);
    if (flags_of(store) != (p->head.flags & ~(uint32_t)IN_MEDIA))
        return checked_refuse_damaged(&f->reader, "its photons are of two sorts", error);
    if (!go_to(f, p, error))
        return false;
    for (size_t i = 0; i < n; i++) {
        char *to = (char *)arrays[i].data + store->n * arrays[i].size;
        if (!checked_get(&f->reader, to, p->head.n * arrays[i].size, "photons", error))
            return false;
    }
    store->n += p->head.n;
    return true;
}

static bool read_store(const photon_file *f, const wanted *what, photon_store *store,
                       GError **error)
{
    size_t n = 0;
    const place *places = (const place *)(const void *)f->places->data;
    for (guint i = 0; i < f->places->len; i++)
        if (is_wanted(&places[i], what)) {
            *store = store_of(places[i].head.flags);
            n += places[i].head.n;
        }
    bool ok = photon_store_reserve(store, n, error);
    for (guint i = 0; i < f->places->len && ok; i++)
        if (is_wanted(&places[i], what))
            ok = read_photons(f, &places[i], store, error);
    return ok;
}

bool photon_file_take(const void *file, uint32_t pass, photon_class c, int slice,
                      trace_result *result, GError **error)
{
    const photon_file *f = file;
    wanted what = {.pass = pass, .slice = (uint32_t)slice, .c = (uint32_t)c};
    *result = (trace_result){0};
    bool ok = read_store(f, &what, &result->photons, error);
    what.in_media = true;
    ok = ok && read_store(f, &what, &result->in_media, error);
    if (!ok)
        trace_result_clear(result);
    return ok;
}
