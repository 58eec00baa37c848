#include "transport/transport.h"

#include "transport/auto.h"
#include "transport/path.h"
#include "transport/photonmap.h"

/* In the order of integrator_choice. */
static const transport_kind *const kinds[] = {
    [INTEGRATOR_PHOTONMAP] = &transport_photonmap,
    [INTEGRATOR_PATH] = &transport_path,
    [INTEGRATOR_AUTO] = &transport_auto,
};

const transport_kind *transport_find(int integrator)
{
    return kinds[integrator];
}

void transport_plan_clear(transport_plan *plan)
{
    emission_guide_free(plan->guide);
    plan->guide = NULL;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_clear_pointer(&plan->radius_map[c], photon_map_free);
}
