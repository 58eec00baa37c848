#include "render/photon_share.h"

int64_t photon_share_of(int64_t n, double share)
{
    return MAX((int64_t)((double)n * share), MIN(n, PHOTON_SHARE_LEAST));
}

void photon_share_take(settings *how, double share)
{
    if (share >= 1.0)
        return;
    how->photons = photon_share_of(settings_photons(how), share);
    for (int c = 0; c < N_CLASSES; c++)
        if (how->class_photons[c] > 0)
            how->class_photons[c] = photon_share_of(how->class_photons[c], share);
}
