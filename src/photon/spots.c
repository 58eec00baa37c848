#include "photon/spots.h"

#include "light/light_tree.h"
#include "math/frame.h"
#include "math/median.h"
#include "math/warp.h"
#include "photon/map/point_set.h"

#include <string.h>

/* So many cover a caustic or what sun comes through a window; a look asks a tree of them.
   Without any a room with a window has five times the relMSE. */
enum { MOST_SPOTS = 512 };

/* math: that a spot reaches, itself among them: so many equal discs touch one. */
enum { NEIGHBOURS = 7 };

typedef struct disc {
    vec3 p, n;
    float radius;
    float power; /* its share of its source's */
} disc;

struct photon_spots {
    size_t n;
    disc *discs;      /* MOST_SPOTS at most */
    light_tree *tree; /* over them and where rays to them may land */
};

/* math: how far from its centre a ray to a disc may land, in radii; see disc_pdf. */
#define LANDING_REACH ((float)G_SQRT2)

/* ---- Building ---- */

static size_t count(const spot_source *from)
{
    return !from->photons            ? from->n_places
           : from->photons->oriented ? from->photons->n
                                     : 0;
}

static double worth(const spot_source *from, size_t i)
{
    float power = from->photons ? spectrum_mean(photon_store_flux(from->photons, i))
                                : from->places[i].power;
    return isfinite(power) && power > 0.0f ? (double)power : 0.0;
}

static disc disc_at(const spot_source *from, size_t i, float power)
{
    if (from->photons) {
        const photon at = photon_store_get(from->photons, i);
        return (disc){at.p, at.n, from->least, power};
    }
    const float *p = from->places[i].p, *n = from->places[i].n;
    return (disc){vec3_make(p[0], p[1], p[2]), vec3_make(n[0], n[1], n[2]), from->least,
                  power};
}

/* Adds discs of the least radius at even steps of the sum of power; their own is how many
   steps fell on one. */
static void choose_places(const spot_source *from, size_t most, photon_spots *spots)
{
    double total = 0.0, sum = 0.0;
    size_t n = count(from);
    for (size_t i = 0; i < n; i++)
        total += worth(from, i);
    size_t n_steps = MIN(n, most), steps = 0;
    for (size_t i = 0; i < n && total > 0.0; i++) {
        size_t before = steps;
        sum += worth(from, i);
        while (steps < n_steps && sum * (double)n_steps > ((double)steps + 0.5) * total)
            steps++;
        if (steps == before)
            continue;
        float power = (float)(steps - before) / (float)n_steps;
        spots->discs[spots->n++] = disc_at(from, i, power);
    }
}

/* @return false: nothing is lit */
static bool choose_all(const spot_source *sources, size_t n, photon_spots *spots)
{
    size_t n_known = 0;
    for (size_t i = 0; i < n; i++)
        n_known += count(&sources[i]) > 0;
    for (size_t i = 0; i < n; i++)
        if (count(&sources[i]) > 0)
            choose_places(&sources[i], MOST_SPOTS / n_known, spots);
    return spots->n > 0;
}

/* The way to the furthest of the neighbours of each place. */
static bool measure_ways(const photon_spots *spots, const point_set *index,
                         float ways[MOST_SPOTS])
{
    point_hits hits = {0};
    bool ok = true;
    for (size_t i = 0; i < spots->n && ok; i++) {
        float d2 = 0.0f;
        ok = point_set_nearest(index, spots->discs[i].p, NEIGHBOURS, INFINITY, &hits);
        for (size_t k = 0; k < hits.n; k++)
            d2 = maxf(d2, hits.distance2[k]);
        ways[i] = sqrtf(d2);
    }
    point_hits_clear(&hits);
    return ok;
}

static bool find_ways(const photon_spots *spots, float ways[MOST_SPOTS], GError **error)
{
    vec3 centres[MOST_SPOTS];
    for (size_t i = 0; i < spots->n; i++)
        centres[i] = spots->discs[i].p;
    point_set *index = point_set_build(centres, spots->n, 1, error);
    if (!index)
        return false;
    bool ok = measure_ways(spots, index, ways);
    if (!ok)
        error_set(error, ERROR_FAILED, "out of memory: bright spots");
    point_set_free(index);
    return ok;
}

/* @return false: memory is refused or, without an error, all lie in one place */
static bool set_radii(photon_spots *spots, GError **error)
{
    float ways[MOST_SPOTS] = {0}, sorted[MOST_SPOTS], widest = 0.0f;
    if (!find_ways(spots, ways, error))
        return false;
    memcpy(sorted, ways, sizeof sorted);
    float most = WIDEST_OVER_TYPICAL * median(sorted, spots->n);
    for (size_t i = 0; i < spots->n; i++) {
        disc *d = &spots->discs[i];
        d->radius = maxf(minf(ways[i], most), d->radius);
        widest = maxf(widest, d->radius);
    }
    return widest > 0.0f;
}

static void plant_tree(photon_spots *spots)
{
    size_t n = spots->n;
    light_bound *bounds = g_aligned_alloc0(n, sizeof *bounds, 16);
    for (size_t i = 0; i < n; i++) {
        const disc *d = &spots->discs[i];
        float r = LANDING_REACH * d->radius;
        vec3 reach = vec3_make(r, r, r);
        box3 box = {d->p - reach, d->p + reach};
        bounds[i] = (light_bound){.is_local = true, .box = box, .power = d->power};
    }
    spots->tree = light_tree_new(bounds, (int)n);
    g_aligned_free(bounds);
}

photon_spots *photon_spots_new(const spot_source *sources, size_t n, GError **error)
{
    g_autoptr(photon_spots) spots = g_new0(photon_spots, 1);
    spots->discs = g_aligned_alloc0(MOST_SPOTS, sizeof *spots->discs, 16);
    if (!choose_all(sources, n, spots) || !set_radii(spots, error))
        return NULL;
    plant_tree(spots);
    return g_steal_pointer(&spots);
}

void photon_spots_free(photon_spots *spots)
{
    if (!spots)
        return;
    light_tree_free(spots->tree);
    g_aligned_free(spots->discs);
    g_free(spots);
}

/* ---- Sampling ---- */

/* pdf_solid_angle of the direction, by places on the disc; 0 if the ray misses it, or
   lands further from it along the ray than it is wide. */
static float disc_pdf(const disc *d, vec3 from, vec3 wi, vec3 landed)
{
    float r2 = d->radius * d->radius, cosine = dot3(wi, d->n);
    if (!(length3_2(landed - d->p) < 2.0f * r2))
        return 0.0f;
    float t = dot3(d->p - from, d->n) / cosine;
    if (!(t > 0.0f) || !isfinite(t))
        return 0.0f;
    vec3 pierced = from + t * wi;
    if (!(length3_2(pierced - d->p) < r2) || !(length3_2(landed - pierced) < r2))
        return 0.0f;
    return t * t / (fabsf(cosine) * PI_F * r2);
}

bool photon_spots_sample(const photon_spots *spots, vec3 from, float u_choice, vec2 u,
                         int *spot, vec3 *wi)
{
    float probability;
    *spot = light_tree_sample(spots->tree, from, u_choice, &probability);
    const disc *d = &spots->discs[*spot];
    frame plane = frame_from_normal(d->n);
    vec2 on = warp_disk(u);
    vec3 to = d->p + d->radius * (on.x * plane.s + on.y * plane.t) - from;
    *wi = normalize3(to);
    return length3_2(to) > 0.0f;
}

bool photon_spots_landed(const photon_spots *spots, int spot, vec3 from, vec3 wi,
                         vec3 landed)
{
    return disc_pdf(&spots->discs[spot], from, wi, landed) > 0.0f;
}

typedef struct landing {
    const disc *discs;
    vec3 from, wi, landed;
} landing;

static float pdf_of_disc(const void *data, int spot)
{
    const landing *at = data;
    return disc_pdf(&at->discs[spot], at->from, at->wi, at->landed);
}

float photon_spots_pdf(const photon_spots *spots, vec3 from, vec3 wi, vec3 landed)
{
    const landing at = {spots->discs, from, wi, landed};
    return light_tree_sum_at(spots->tree, from, landed, pdf_of_disc, &at);
}
