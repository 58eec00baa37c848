#include "photon/trace/photon_path.h"

void photon_path_tell_flux(const photon_path *path, photon_event_kind kind,
                           const surface_hit *hit, unsigned lobe, spectrum flux)
{
    if (!path->tell)
        return;
    photon_event event = {
        .kind = kind,
        .index = path->index,
        .p = hit ? hit->p : path->at.ray.origin,
        .direction = path->at.ray.direction,
        .hit = hit,
        .light = path->light,
        .lobe = lobe,
        .flux = flux,
        .mis_weight = path->mis_weight,
    };
    path->tell(&event, path->tell_data);
}

bool photon_path_goes_on(const photon_path *path)
{
    const trace_task *task = path->task;
    return task->photon_class == PHOTON_CAUSTIC && task->mis;
}

static photon_class class_here(const photon_path *path)
{
    if (photon_path_goes_on(path) && path->n_after > 0)
        return PHOTON_CAUSTIC;
    if (path->n_diffuse > 0)
        return PHOTON_INDIRECT;
    return path->n_followed > 0 ? PHOTON_CAUSTIC : PHOTON_DIRECT;
}

bool photon_path_is_wanted(const photon_path *path)
{
    const trace_task *task = path->task;
    photon_class c = class_here(path);
    if (settings_one_map(task->how))
        return c != PHOTON_DIRECT || !task->how->direct_illumination;
    return c == task->photon_class;
}

static float power_of(const settings *how, spectrum flux)
{
    return how->roulette == ROULETTE_MAX ? spectrum_max(flux) : spectrum_mean(flux);
}

bool photon_path_survives(photon_path *path, spectrum flux, float survival, float u)
{
    if (!(u < survival))
        return false;
    path->at.throughput = flux / survival;
    return true;
}

float photon_path_survival(const photon_path *path, spectrum flux)
{
    const settings *how = path->task->how;
    return minf(1.0f, power_of(how, flux) / power_of(how, path->at.throughput));
}
