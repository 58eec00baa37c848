/*
 * The trial of gathering: maps of few photons, and places of the film that are asked of
 * them and of paths.
 */
#pragma once

#include "transport/path/path.h"
#include "transport/photonmap/photonmap.h"

/** @brief What two maps and two paths say of a place of the film: light, mean over
 * wavelengths, W m⁻² sr⁻¹ nm⁻¹. */
typedef struct gather_place {
    double path[2], smooth[2]; /* each with a sampler of its own */
    double near[2], twice[2];  /* all with the first one */
    double scattered[2];       /* part of smooth: trial_light's */
    double beside;             /* as smooth[0], of the next pixel */
    double seen;               /* with the caustics that those leave out */
    double lone;               /* square of what one photon adds, times its disc, m² */
    double area;               /* of a pixel, m² */
    double first_rays;         /* of a pixel's first sample, photons not weighed yet */
    double later_rays;         /* of another one, which shares the first one's looks */
    double weigh_rays;         /* and of either what weighing photons takes */
    double path_rays;          /* of a path */
    double all_rays;
} gather_place;

/** @brief The trial: zeroed, then filled. */
typedef struct gather_trial {
    transport_plan plan; /* of photons, as it would be: the caller's to fill */
    transport_plan few[2];
    photonmap_pass *maps[2];
    /* The same with wider discs: near and twice with area times as much of them and four
       times that, smooth with fewer times, in which there are as many photons as in the
       plan's; and priced as smooth, but looked around as the plan's. */
    photonmap_pass *near[2], *twice[2], *smooth, *priced;
    double area;
    double fewer;       /* photons than the plan's, over them */
    double flux;        /* of a photon of the plan's, W nm⁻¹ */
    double photon_rays; /* of a whole pass */
    double first_rays, later_rays, weigh_rays, path_rays; /* means of the places' */
    uint32_t n;                                           /* places */
    gather_place *places;
} gather_trial;

/** @brief Whether a plan's grant is enough for the least of trials. */
bool gather_trial_granted(const transport_plan *plan);

/** @brief Sends few photons, twice, and asks at places.
 *  @param plan the one that grants it
 *  @param paths a pass as that plan has it
 *  @return false when cancelled or out of memory */
bool gather_trial_run(gather_trial *t, transport_plan *plan, const path_pass *paths,
                      const cancel_flag *cancel, GError **error);

/** @brief Rays of a sample by maps: of a pixel's the first looks for edges. */
double gather_trial_sample_rays(const gather_trial *t);

/** @brief Frees maps and places; its plan stays the caller's. */
void gather_trial_clear(gather_trial *t);
