/*
 * How much flux a photon pass leaves, with its error.
 */
#pragma once

#include "photon/trace/trace.h"
#include "transport/transport.h"

/** Mean and standard error, over the mean of wavelengths, of the flux per emission. */
typedef struct flux_mean {
    double mean, error;
} flux_mean;

static inline double flux_of(const photon_store *store)
{
    double sum = 0;
    for (size_t i = 0; i < store->n; i++)
        sum += (double)spectrum_mean(store->flux[i]);
    return sum;
}

/** Of n photons of a class: what they leave on surfaces, or in media. */
static inline flux_mean flux_left(const transport_plan *plan, photon_class c,
                                  bool in_media, uint64_t n)
{
    enum { BATCHES = 16 };
    g_autoptr(caustic_casters) casters = caustic_casters_new(plan->scene, NULL);
    double sum = 0, sum2 = 0;
    for (uint32_t batch = 0; batch < BATCHES; batch++) {
        const trace_task task = {.scene = plan->scene,
                                 .how = &plan->how,
                                 .w = wavelengths_at(0.5f),
                                 .pass = batch,
                                 .photon_class = c,
                                 .casters = casters,
                                 .guide = plan->guide[c],
                                 .n_photons = n / BATCHES};
        trace_result result;
        g_assert_true(photon_trace(&task, false, &result, NULL));
        double flux = flux_of(in_media ? &result.in_media : &result.photons);
        trace_result_clear(&result);
        sum += flux;
        sum2 += flux * flux;
    }
    double mean = sum / BATCHES;
    return (flux_mean){mean,
                       sqrt(fmax(0.0, sum2 / BATCHES - mean * mean) / (BATCHES - 1))};
}
