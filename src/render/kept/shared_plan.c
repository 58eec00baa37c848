/*
 * A plan that one process has made, for others that render passes of the same picture: it
 * takes time that does not shrink with their number, and they need not decide alike.
 *
 *   program, scene    whose it is
 *   plan              transport/plan/plan_bytes.h
 *   SHA-256           of all that
 */
#include "base/bytes.h"
#include "render/footprint.h"
#include "render/render_state.h"
#include "transport/plan/plan_bytes.h"

enum { SUM_BYTES = 32 };

static void put_text(GByteArray *to, const char *text)
{
    size_t length = strlen(text);
    bytes_put_count(to, length);
    bytes_put(to, text, length, 1);
}

static void sum_of(const void *data, size_t size, guint8 out[SUM_BYTES])
{
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    gsize length = SUM_BYTES;
    g_checksum_update(sum, data, (gssize)size);
    g_checksum_get_digest(sum, out, &length);
}

GBytes *render_plan_bytes(render *r, const render_identity *who, GError **error)
{
    render_plan plan;
    guint8 sum[SUM_BYTES];
    if (!render_get_plan(r, &plan, error))
        return NULL;
    GByteArray *out = g_byte_array_new();
    put_text(out, who->program);
    put_text(out, who->scene);
    plan_put(&r->plan, out);
    sum_of(out->data, out->len, sum);
    bytes_put(out, sum, SUM_BYTES, 1);
    return g_byte_array_free_to_bytes(out);
}

/* ---- Reading ---- */

static bool refuse(GError **error, const char *why)
{
    error_set(error, ERROR_INPUT, "cannot take over a plan: %s", why);
    return false;
}

static bool is_text(bytes_reader *from, const char *expected)
{
    size_t length = bytes_get_count(from, 1);
    bool same = !from->failed && length == strlen(expected) &&
                memcmp(from->at, expected, length) == 0;
    from->at += from->failed ? 0 : length;
    return same;
}

static bool is_whole(const guint8 *data, size_t size)
{
    guint8 sum[SUM_BYTES];
    if (size <= SUM_BYTES)
        return false;
    sum_of(data, size - SUM_BYTES, sum);
    return memcmp(sum, data + size - SUM_BYTES, SUM_BYTES) == 0;
}

static bool read_plan(render *r, bytes_reader *from, GError **error)
{
    const settings how = r->plan.how;
    bool ok = plan_get(&r->plan, from->at, (size_t)(from->end - from->at), error) &&
              footprint_fit(&r->plan, r->beside, false, &r->cancel, error);
    if (ok) { /* who dealt the passes knows when it is over */
        r->plan.how.time = how.time;
        return true;
    }
    transport_plan_clear(&r->plan);
    r->plan = transport_plan_of(r->plan.view, &how);
    return false;
}

bool render_take_plan(render *r, const render_identity *who, GBytes *bytes,
                      GError **error)
{
    gsize size;
    const guint8 *data = g_bytes_get_data(bytes, &size);
    if (r->passes_done > 0 || r->prepared || r->photons) {
        error_set(error, ERROR_USAGE, "cannot take over a plan: there is one");
        return false;
    }
    if (!is_whole(data, size))
        return refuse(error, "it is damaged");
    bytes_reader from = {.at = data, .end = data + size - SUM_BYTES};
    if (!is_text(&from, who->program))
        return refuse(error, "another version of the program made it");
    if (!is_text(&from, who->scene))
        return refuse(error, "it is of another scene");
    if (!read_plan(r, &from, error))
        return false;
    r->plan.cancel = &r->cancel;
    r->first_plan = render_first_plan(&r->plan);
    return r->prepared = r->paced = true;
}
