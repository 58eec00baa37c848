/*
 * What planning may cost: a part of the work that is asked for, both counted in rays and
 * never by the clock, so that the same input gives the same plan whatever machine it is
 * made on.
 *
 *   sight   where the camera looks (visible.h)      1/2 share    where photons are sent
 *   paths   what paths find by themselves           1/2 share    auto
 *   aim     trial photons, which teach the guide      2 shares   where casters are
 *   radii   how dense photons lie (radius.c)          2 shares   where photons are sent
 *   pass    a small one, to try spots with          1/2 share    auto
 *   noise   what paths find beside its photons      1/2 share    auto
 *   spots   what looking at bright spots is worth     1 share    auto
 *   gather  what gathering all light is worth     3 1/2 shares   auto: radii, two maps,
 *                                                                places
 */
#pragma once

#include "transport/transport.h"

/** A share of the work asked for. All trials took 1.0 to 4.5 % of the rays that plans are
 * told to take (thirteen scenes, those of bench/equal_time among them, 256 x 256, 1 s);
 * with twice as much shown errors are .92 of that after 1 s and 1.05 after 3, with four
 * times 1.09 and 1.06 (seventeen scenes). */
#define TRIAL_SHARE 0.0085

/** What a camera sample costs, in rays, before any is traced: as many as a path goes on
 * for certain. Counted were 3.3 in scenes/cornell-box, 3.7 in scenes/ring, 4.0 in
 * scenes/glass-ball, and 7 in a closed room. */
#define SAMPLE_RAYS ((double)ROULETTE_BOUNCES)

/** What a photon costs, in rays, and what a query of a map does with all that it looks
 * at. Counted were 0.9 to 1.1 where photons start uniformly in scenes/ring and
 * scenes/glass-ball, 1.4 and 2.9 where they start guided; by the clock gathers took 1.7
 * rays for each surface met in the first and 1.0 in the other, where half of them gather.
 */
#define PHOTON_RAYS 2.0

/** What a short ray costs that looks for edges, in rays. A query whose looks are counted
 * costs one ray, and as many photons as there are wavelengths, or one that a BSDF weighs
 * at all of them, half of a look: so the rays of passes that gather all, over those of
 * passes by paths, come close to what both took of the clock: 17 % in the mean square,
 * from .7 to 1.7, sixteen scenes, 128 to 512 pixels wide, 1 to 16 passes. With 0.3 and
 * photons of wide discs it was 23 %, from .4 to 1.9. */
#define LOOK_RAYS 0.2

/** What is tried must be better than what is there by so much: variances are known within
 * a factor of two, and noise that is even disturbs least. With 1 in its place time x
 * relMSE is 1.3 to 1.7 times as much in a Cornell box and 1.1 to 1.2 in one with glass
 * and in water, alike in three other scenes (64 x 64, 4 to 64 passes, five seeds). */
#define CLEARLY_BETTER 0.65

/** Squared error that is alike in neighbouring pixels weighs as much as so many times
 * that of grain where noise is taken out, which leaves what is alike as it is: of paths'
 * noise it left a 40th to a 90th in five rooms with walls of one colour, a 25th to a
 * 60th with glass balls, by a glass ball and in fog, a 10th in a papered room, in water
 * and through a window (256 x 256, 1 to 8 passes). Of maps and paths what is chosen
 * costs, by time x squared error of what is shown, 1.05 of the best in the mean of 148
 * pictures (sixteen scenes, 128 to 512 pixels wide, 1 to 16 passes, four seeds each);
 * with 24 it is 1.07, with 48 1.06. */
#define BLOTCHES 32.0

/** Fewer trials of anything tell nothing, as fewer photons do of how close they lie: then
 * the decision is the cheap one. A thread takes as many at once, some hundred
 * microseconds. */
enum { LEAST_TRIALS = RADIUS_NEAREST };

/** Photons, or light subpaths, of a share that tell how dense they lie: those that a
 * distance is measured by, for each of the places. */
enum { MOST_PILOTS = RADIUS_NEAREST * MOST_PLACES };

/** What traces photons, or light subpaths, before the first pass; the guide does more
 * than once. */
enum { TRIAL_RADII, TRIAL_VERTICES, TRIAL_GUIDE };

/** @brief The pass that they are of: one that no render reaches, so that they are not
 * those of pass 0. */
static inline uint32_t plan_trial_pass(uint32_t trial)
{
    return UINT32_MAX - trial;
}

/** @brief Rays that are worth the photons of a pass: sending and storing one takes as
 * long as one more. */
double plan_rays_of_photons(const transport_counts *counts);

/** @brief Rays that are worth what has been done with scratch. */
double plan_rays_of(const transport_scratch *scratch);
/** @brief The same, but for weighing photons that were found. */
double plan_rays_of_search(const transport_scratch *scratch);
/** @brief That weighing so many numbers of photons is worth. */
double plan_rays_of_weighed(double n);

/** @brief Notes photons of a trial, and the rays that were traced for them. */
void plan_note_photons(transport_plan *plan, double n, double rays);

/** @brief What one costs in a trial, in rays: as those before did. */
double plan_photon_rays(const transport_plan *plan);

/** @brief Camera samples of all passes that are planned. */
double plan_samples(const transport_plan *plan);

/** @brief Notes what is asked for: the camera's samples, and n photons in each pass. */
void plan_ask(transport_plan *plan, double n_photons);

/** @brief Rays that trials of so many shares may cost. */
double plan_grant(const transport_plan *plan, double shares);

/** @brief So many trials that cost that many rays each: few if the work is, LEAST_TRIALS
 * at least, and never more than most a share. */
uint32_t plan_trials_for(const transport_plan *plan, double shares, double rays_each,
                         uint32_t most);

/** @brief Whether noise is taken out of a picture of all passes that are planned. */
bool plan_takes_noise_out(const transport_plan *plan);

/** @brief What error that is alike in neighbouring pixels weighs over grain, in a picture
 * of all passes that are planned: BLOTCHES, or 1 where noise stays. */
double plan_weight_alike(const transport_plan *plan);

/** @brief True where so little is asked for that the fewest trials do not fit in. */
bool plan_is_tiny(const transport_plan *plan);

/** @brief Notes an alternative that was measured; each of with and without: of a sample
 *  or a photon. @param what static */
void plan_note(transport_plan *plan, const char *what, plan_cost without, plan_cost with,
               bool taken);
