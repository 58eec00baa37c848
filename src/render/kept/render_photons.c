/*
 * Passes whose photons were traced before and lie in a file.
 */
#include "render/kept/photon_file.h"
#include "render/render_state.h"

void *render_begin_pass(render *r, const transport_plan *plan, uint32_t index,
                        transport_counts *counts, GError **error)
{
    if (!r->photons)
        return r->transport->begin_pass(plan, index, &r->cancel, counts, error);
    if (r->kept_pass)
        return r->kept_pass;
    uint32_t n = (uint32_t)photon_file_passes(r->photons);
    void *pass = r->transport->begin_pass(&r->plan, index % n, &r->cancel, counts, error);
    if (n == 1)
        r->kept_pass = pass;
    return pass;
}

void render_end_pass(const render *r, void *pass)
{
    if (pass != r->kept_pass)
        r->transport->end_pass(pass);
}

bool render_plan_by_file(render *r, GError **error)
{
    if (!photon_file_plan(r->photons, &r->plan, error)) {
        const settings how = r->plan.how;
        transport_plan_clear(&r->plan);
        r->plan = transport_plan_of(r->plan.view, &how);
        return false;
    }
    r->plan.cancel = &r->cancel;
    r->plan.supply = &r->supply;
    return true;
}

char *render_digest(const render *r)
{
    const render_plan plan = render_plan_of(&r->plan);
    g_autofree char *digest = render_plan_digest(&plan);
    return g_strdup_printf("%s%s%s", digest, r->photons ? " photons " : "",
                           r->photons ? photon_file_id(r->photons) : "");
}

void render_forget_photons(render *r)
{
    if (r->kept_pass)
        r->transport->end_pass(r->kept_pass);
    r->kept_pass = NULL;
    g_clear_pointer(&r->photons, photon_file_free);
}

bool render_use_photons(render *r, const render_identity *who, const char *path,
                        GError **error)
{
    if (r->passes_done > 0 || r->prepared) {
        error_set(error, ERROR_USAGE, "cannot use %s: the render has begun", path);
        return false;
    }
    g_autoptr(photon_file) file = photon_file_open(path, error);
    if (!file || !photon_file_suits(file, who, &r->asked, error))
        return false;
    photon_file_free(r->photons);
    r->photons = g_steal_pointer(&file);
    r->supply = (photon_supply){photon_file_take, r->photons};
    r->paced = true;
    return true;
}
