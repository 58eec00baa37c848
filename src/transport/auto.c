#include "transport/auto.h"

#include "transport/aim.h"
#include "transport/path.h"
#include "transport/photonmap.h"

static bool prepare(transport_plan *plan, const cancel_flag *cancel, GError **error)
{
    int64_t own = plan->how.class_photons[PHOTON_CAUSTIC];
    bool needed = plan->scene->n_caustic_shapes > 0;
    plan->n_photons[PHOTON_CAUSTIC] =
        needed ? (uint64_t)(own > 0 ? own : plan->how.photons) : 0;
    return aim_caustics(plan, cancel, error) &&
           photonmap_choose_radii(plan, cancel, error);
}

static void end_pass(void *data)
{
    path_pass *pass = data;
    if (pass->caustics)
        transport_photonmap.end_pass(pass->caustics);
    transport_path.end_pass(pass);
}

static void *begin_pass(const transport_plan *plan, uint32_t index,
                        const cancel_flag *cancel, transport_counts *counts,
                        GError **error)
{
    path_pass *pass = transport_path.begin_pass(plan, index, cancel, counts, error);
    if (!pass || plan->n_photons[PHOTON_CAUSTIC] == 0)
        return pass;
    pass->caustics = transport_photonmap.begin_pass(plan, index, cancel, counts, error);
    if (!pass->caustics) {
        end_pass(pass);
        return NULL;
    }
    return pass;
}

static const wavelengths *pass_wavelengths(const void *pass)
{
    return transport_path.pass_wavelengths(pass);
}

const transport_kind transport_auto = {
    .name = "auto",
    .light_groups = true,
    .prepare = prepare,
    .begin_pass = begin_pass,
    .radiance = path_radiance,
    .pass_wavelengths = pass_wavelengths,
    .end_pass = end_pass,
};
