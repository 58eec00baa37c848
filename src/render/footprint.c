#include "render/footprint.h"

#include "base/memory.h"
#include "render/film_halves.h"
#include "render/film_planes.h"

#include <math.h>

enum { PROBE = 1 << 16 /* size: so many photons tell what one takes */ };

static uint64_t n_photons(const transport_plan *plan)
{
    uint64_t n = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += plan->n_photons[c];
    return n;
}

/* The most that arrays had at once while a pass of this plan was begun. */
static size_t begin_and_end(const transport_plan *plan)
{
    const transport_kind *kind = transport_find((int)plan->how.integrator);
    transport_counts counts = {0};
    size_t before = memory_forget_most();
    void *pass = kind->begin_pass(plan, 0, NULL, &counts, NULL);
    size_t most = memory_most();
    if (pass)
        kind->end_pass(pass);
    return most - MIN(most, before);
}

static size_t photon_bytes(const transport_plan *plan)
{
    transport_plan small = *plan;
    double share = fmin((double)PROBE / (double)MAX(n_photons(plan), 1), 1.0);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        small.n_photons[c] = (uint64_t)ceil((double)plan->n_photons[c] * share);
    return (size_t)((double)begin_and_end(&small) / share);
}

static size_t plan_bytes(const view *v, const settings *how)
{
    transport_plan plan = transport_plan_of(v, how);
    size_t bytes = 0;
    if (transport_plan_prepare(&plan, NULL, NULL) && n_photons(&plan) > 0)
        bytes = photon_bytes(&plan);
    transport_plan_clear(&plan);
    return bytes;
}

size_t footprint_of(const view *v, const settings *how)
{
    size_t now = memory_resident(), before = memory_peak();
    film_size size = film_size_for(v, how->denoise);
    bool several = settings_most_passes(how) > 1.0;
    size_t denoising = several ? size.denoising : 0;
    size_t written = size.sums + MAX(denoising, size.image + size.writing);
    size_t rendered = (several ? size.sums : size.pass) + plan_bytes(v, how);
    return MAX(before, now + MAX(written, rendered));
}
