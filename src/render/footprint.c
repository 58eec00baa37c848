#include "render/footprint.h"

#include "base/memory.h"
#include "base/slab_list.h"
#include "render/film/film_planes.h"
#include "render/photon_share.h"

#include <math.h>

enum {
    TRIAL_PHOTONS = 1 << 16, /* size: so many photons tell what one takes */
    PHOTON_MOST = 4 << 10,   /* bytes: what one takes, in all places where it is stored */
    TRIES = 8,               /* to choose photons: each time a tenth fewer at least */
};

/* Passes differ in what their photons take, and are planned for so much more. */
#define MARGIN 1.1

static uint64_t n_photons(const transport_plan *plan)
{
    uint64_t n = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += plan->n_photons[c];
    return n;
}

size_t footprint_begun(const settings *how)
{
    return (2 * (size_t)parallel_threads((unsigned)how->threads) + 1) * SLAB_BYTES;
}

/* The most that arrays had at once while a pass of this plan was begun. */
static size_t begin_and_end(const transport_plan *plan, const cancel_flag *cancel)
{
    const transport_kind *kind = transport_find((int)plan->how.integrator);
    transport_counts counts = {0};
    size_t before = memory_forget_most();
    void *pass = kind->begin_pass(plan, 0, cancel, &counts, NULL);
    size_t most = memory_most();
    if (pass)
        kind->end_pass(pass);
    return most - MIN(most, before);
}

/* What the photons of a pass take, as so many of them tell. */
static size_t photon_bytes(const transport_plan *plan, double trial,
                           const cancel_flag *cancel)
{
    transport_plan small = *plan;
    small.how.threads = 1; /* several have more at once, or less, as it happens */
    double share = fmin(trial / (double)MAX(n_photons(plan), 1), 1.0);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        small.n_photons[c] = (uint64_t)ceil((double)plan->n_photons[c] * share);
    return (size_t)((double)begin_and_end(&small, cancel) / share);
}

static size_t plan_bytes(const view *v, const settings *how)
{
    transport_plan plan = transport_plan_of(v, how);
    size_t bytes = 0;
    if (transport_plan_prepare(&plan, NULL, NULL) && n_photons(&plan) > 0)
        bytes = photon_bytes(&plan, TRIAL_PHOTONS, NULL);
    transport_plan_clear(&plan);
    return bytes + MIN(bytes, footprint_begun(how)); /* little is put into one page */
}

size_t footprint_of(const view *v, const settings *how)
{
    size_t now = memory_resident(), before = memory_peak();
    film_size size = film_size_for(v, how->denoise);
    bool several = settings_most_passes(how) > 1.0;
    bool denoises = settings_takes_noise_out(how, settings_most_passes(how));
    size_t denoising = denoises ? size.denoising : 0;
    size_t written = size.sums + MAX(denoising, size.image + size.writing);
    size_t rendered = (several ? size.sums : size.pass) + plan_bytes(v, how);
    return MAX(before, now + MAX(written, rendered));
}

/* ---- Photons that fit ---- */

bool footprint_check(size_t beside, GError **error)
{
    char all[MEMORY_SIZE_TEXT], limit[MEMORY_SIZE_TEXT];
    if (beside <= memory_limit())
        return true;
    memory_write_size(beside, all);
    memory_write_size(memory_limit(), limit);
    error_set(error, ERROR_FAILED,
              "out of memory: %s at least for rendering, beyond the limit of %s", all,
              limit);
    return false;
}

static bool refuse_photons(size_t beside, size_t need, const transport_plan *plan,
                           GError **error)
{
    char all[MEMORY_SIZE_TEXT], theirs[MEMORY_SIZE_TEXT], limit[MEMORY_SIZE_TEXT];
    memory_write_size(beside + need, all);
    memory_write_size(need, theirs);
    memory_write_size(memory_limit(), limit);
    error_set(error, ERROR_FAILED,
              "out of memory: %s at least for rendering, %s of it for %" G_GUINT64_FORMAT
              " photons a pass, beyond the limit of %s",
              all, theirs, n_photons(plan), limit);
    return false;
}

/* Down to quarters of a power of two: what a process has beside differs by some hundred
   kilobytes from run to run, and the photons shall be the same again. */
static int64_t rounded(int64_t n)
{
    int64_t power = 1;
    while (power <= n / 2)
        power *= 2;
    return power < 4 ? n : n / (power / 4) * (power / 4);
}

/* @return false: there are as few as there may be */
static bool send_fewer(transport_plan *plan, double share)
{
    settings *how = &plan->how;
    const settings before = *how;
    uint64_t times = how->photons_per_light ? MAX(plan->scene->lights->len, 1) : 1;
    how->photons = MIN(settings_photons(how), (int64_t)MAX(n_photons(plan) / times, 1));
    photon_share_take(how, share);
    bool fewer = how->photons < settings_photons(&before);
    how->photons = rounded(how->photons);
    for (int c = 0; c < N_CLASSES; c++) {
        how->class_photons[c] = rounded(how->class_photons[c]);
        fewer |= how->class_photons[c] < before.class_photons[c];
    }
    return fewer;
}

/* What they take that are planned, and a margin. As few as fit whatever they take tell of
   too much each, by what does not depend on their number: they only say how many may be
   tried. */
static size_t photons_need(const transport_plan *plan, size_t room,
                           const cancel_flag *cancel)
{
    double n = (double)n_photons(plan), tried = 0.0, need = 0.0;
    double trial = CLAMP((double)room / PHOTON_MOST, PHOTON_SHARE_LEAST, TRIAL_PHOTONS);
    while (trial >= 2.0 * tried && !cancelled(cancel)) {
        need = (double)photon_bytes(plan, trial, cancel);
        tried = trial;
        trial = fmin(0.5 * (double)room / fmax(need / n, 1.0), fmin(n, TRIAL_PHOTONS));
    }
    return (size_t)(MARGIN * need);
}

bool footprint_fit(transport_plan *plan, size_t beside, bool may_choose,
                   const cancel_flag *cancel, GError **error)
{
    size_t limit = memory_limit(), room = limit - MIN(beside, limit), need = 0;
    for (int i = 0; i < TRIES && !cancelled(cancel); i++) {
        if (n_photons(plan) <= room / PHOTON_MOST ||
            (need = photons_need(plan, room, cancel)) <= room)
            return true;
        if (!may_choose || !send_fewer(plan, fmin((double)room / (double)need, 0.9)))
            break;
        if (!transport_plan_prepare(plan, cancel, error))
            return false;
    }
    return cancelled(cancel) || refuse_photons(beside, need, plan, error);
}
