#include "transport/plan/gather_costs.h"

#include "transport/plan/trial.h"
#include "transport/work.h"

#include <math.h>

/* What maps blur below the size of their discs no map shows, and paths only when their
   noise is gone. So much at least is its relative square, over that of the radius in
   radii of the scene: .04 to .26 in five rooms (Cornell boxes without and with glass,
   glossy, papered, a glass ball; 2 to 16 passes, 128 x 128). */
#define UNSEEN_BIAS 0.1

/* Mean squared errors of a sample, relative to what is there: in_media is a part of
   samples. Of a whole picture; and of a pixel that shows the next one. */
typedef struct gather_errors {
    double path, samples, in_media, photons, bias2, contrast;
} gather_errors;

static double mean_of(const gather_trial *t)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < t->n; i++)
        sum += t->places[i].seen;
    return sum / t->n;
}

/* How far both paths are from what the map sees. */
static double off_map(const gather_place *at)
{
    double seen = (at->smooth[0] + at->smooth[1]) / 2.0;
    return (fabs(at->path[0] - seen) + fabs(at->path[1] - seen)) / 2.0;
}

/* How far maps are off, as products tell of two of them that have nothing in common. */
typedef struct bias_sum {
    double products, squares;
} bias_sum;

static void bias_add(bias_sum *to, double product)
{
    to->products += product;
    to->squares += product * product;
}

/* As far as it is known from chance. */
static double seen_bias(const bias_sum *of)
{
    return fmax(of->products - sqrt(of->squares), 0.0);
}

static double unseen_bias(const transport_plan *plan)
{
    double share = plan->radius[PHOTON_INDIRECT] / (double)plan->scene->radius;
    return UNSEEN_BIAS * share * share;
}

/* Sums over the places. */
typedef struct gather_sums {
    square_sum path, sample, in_media, photons;
    bias_sum bias;
    double off, beside;
    double lone, area;
} gather_sums;

/* One of n places. */
static void add_place(gather_sums *to, const gather_place *at, double weight, double n)
{
    double w = weight / n, half = 0.5 * w;
    double paths = at->path[0] - at->path[1];
    double samples = at->smooth[0] - at->smooth[1];
    double in_media = at->scattered[0] - at->scattered[1];
    double photons = at->near[0] - at->near[1];
    square_add(&to->path, half * paths * paths);
    square_add(&to->sample, half * samples * samples);
    square_add(&to->in_media, half * in_media * in_media);
    square_add(&to->photons, half * photons * photons);
    bias_add(&to->bias, w * (at->twice[0] - at->near[0]) * (at->twice[1] - at->near[1]));
    to->lone += w * at->lone;
    to->area += at->area / n;
    to->off += off_map(at) * sqrt(weight) / n;
    double off = at->beside - 0.5 * (at->smooth[0] + at->smooth[1]);
    to->beside += w * off * off;
}

/* Variance of photons too rare for few maps to hold one: by Laplace's rule of succession
   the next one that is sent is such a one with a chance of one over all that were; it
   lands anywhere in the picture. */
static double unseen_photons(const gather_trial *t, double lone, double pixel_area)
{
    const int c = PHOTON_INDIRECT;
    const film_settings *film = &t->plan.view->film;
    double tried = (double)t->few[0].n_photons[c] + (double)t->few[1].n_photons[c];
    double seen = pixel_area * (double)film->width * (double)film->height;
    double arrive = (double)t->plan.n_photons[c] / fmax(tried, 1.0);
    return lone > 0.0 ? arrive * lone / seen : 0.0;
}

/* Where noise stays most of it may be what both have in common, such as glints in few
   pixels: it must be that of the same places then. Where it is taken out all paths that
   were tried tell more: what is chosen costs 1.05 of the better of the two, by the same
   places 1.09 (148 pictures of 16 scenes, 128 to 512 pixels square, 1 to 16 passes, four
   seeds). */
static double path_variance(const transport_plan *plan, const gather_sums *sums)
{
    return plan_takes_noise_out(plan) ? plan->path_noise : square_total(&sums->path);
}

/* Where no path found the light that photons came from their noise tells nothing, but how
   far they are off the map does: its mean, since its square is at the mercy of one place.
   Fewer photons have as many times the variance. */
static gather_errors errors_of(const gather_trial *t, const transport_plan *plan)
{
    gather_sums sums = {0};
    double mean = mean_of(t);
    for (uint32_t i = 0; i < t->n && mean > 0.0; i++)
        add_place(&sums, &t->places[i], relative_weight(t->places[i].seen, mean), t->n);
    double samples = square_total(&sums.sample);
    return (gather_errors){
        .path = fmax(path_variance(plan, &sums), sums.off * sums.off),
        .samples = samples,
        .in_media = fmin(square_total(&sums.in_media), samples),
        .photons = square_total(&sums.photons) * t->area / t->fewer +
                   unseen_photons(t, sums.lone, sums.area),
        .bias2 = seen_bias(&sums.bias) / t->area + unseen_bias(&t->plan),
        /* Without the noise of one sample and of the mean of two. */
        .contrast = fmax(sums.beside - (1.0 + 0.5) * sums.sample.sum, 0.0),
    };
}

/* Of so many passes whose radii shrink the variance is, and the bias, over that of the
   first. */
static double variance_of_passes(double alpha, double passes)
{
    return tgamma(alpha) * pow(passes, 1.0 - alpha) / (2.0 - alpha) / passes;
}

static double bias_of_passes(double alpha, double passes)
{
    return pow(passes, alpha - 1.0) / tgamma(1.0 + alpha);
}

/* What n samples a pixel show, times n, of the squared error of one: all, but that fewer
   than one show no more of it where noise stays. */
static double share_of_samples(const transport_plan *plan, double n)
{
    return plan_takes_noise_out(plan) ? 1.0 : fmin(n, 1.0);
}

/* Squared error of n samples a pixel, times n, that paths and maps have in common: light
   straight from lamps is as noisy in both. On surfaces that is where shadows end, which
   no feature tells: it weighs as what is alike in neighbouring pixels does. In media it
   is grain, which weighs as it is said to. n is told within a factor of two: of the
   pixels for which half as many do not suffice all may stay empty, and show the next. */
static double common_error(const transport_plan *plan, const gather_errors *e, double n,
                           double grain)
{
    double weight = plan_weight_alike(plan), empty = fmax(1.0 - 0.5 * n, 0.0);
    double samples = grain * e->in_media + weight * (e->samples - e->in_media);
    return share_of_samples(plan, n) * samples + weight * n * empty * e->contrast;
}

/* Squared error that maps have of their own, times the passes. */
static double error_of_maps(const transport_plan *plan, const gather_errors *e,
                            double passes)
{
    double alpha = plan->how.alpha, whole = fmax(passes, 1.0);
    double bias = bias_of_passes(alpha, whole);
    return passes *
           (e->photons * variance_of_passes(alpha, whole) + e->bias2 * bias * bias);
}

/* A picture by maps: its passes, and rays of a sample with its part of the photons, which
   of a pass that is not whole are all there. Where half a pass does not fit, it is told
   as one that has as much. */
typedef struct maps_in_time {
    double passes, sample_rays;
    bool fit;
} maps_in_time;

/* @param rays that the passes by paths take, as of one sample */
static maps_in_time fit_maps(double rays, double sample_rays, double photon_rays)
{
    double passes = rays / (sample_rays + photon_rays);
    if (passes < 1.0)
        passes = (rays - photon_rays) / sample_rays;
    bool fit = passes >= 0.5;
    passes = fmax(passes, 0.5);
    return (maps_in_time){passes, sample_rays + photon_rays / fmin(passes, 1.0), fit};
}

/* All is comparable to the variance of one sample. Where noise is taken out it is grain
   that goes, and what maps have of their own weighs as it is alike in neighbouring
   pixels; where half a pass does not fit grain stays, too. */
bool gather_costs(const transport_plan *plan, const gather_trial *t, plan_cost *without,
                  plan_cost *with)
{
    const gather_errors e = errors_of(t, plan);
    double passes = settings_planned_passes(&plan->how), spp = (double)plan->how.spp;
    without->rays = t->path_rays + plan->photon_rays;
    without->variance =
        share_of_samples(plan, passes * spp) * fmax(e.path - e.samples, 0.0) +
        common_error(plan, &e, passes * spp, 1.0);
    const maps_in_time maps =
        fit_maps(passes * without->rays, gather_trial_sample_rays(t),
                 t->photon_rays * passes / plan_samples(plan));
    double weight = plan_weight_alike(plan);
    with->rays = maps.sample_rays;
    with->variance = common_error(plan, &e, maps.passes * spp, maps.fit ? 1.0 : weight) +
                     weight * spp * error_of_maps(plan, &e, maps.passes);
    return maps.fit;
}
