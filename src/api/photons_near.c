/*
 * The photons around a point, and the estimate they make: the naive way, one look at each
 * photon, since nobody asks for it more than once a click.
 *
 *   E = Σ κ(d) Φ / ∫∫ κ(s) s ds dθ      over photons on surfaces nearer than r, arrived
 *                                       on the normal's side
 *
 * What counts as near is asked of the renders' own query, so that it is seen here as
 * there. Where something moves all light is in the photons of each slice of time, and
 * this is the mean over slices.
 */
#include "api/photons.h"

#include "photon/kernel.h"
#include "photon/photon_query.h"

#include <math.h>
#include <stdlib.h>

typedef struct neighbour {
    size_t index;
    float distance2;
} neighbour;

static vec3 to_vec3(const double v[3])
{
    return vec3_make((float)v[0], (float)v[1], (float)v[2]);
}

static photon_query query_at(const NephPhotons *photons, int c, vec3 p, vec3 n)
{
    const photon_filter filter = {
        .n = n, .one_sided = true, .flatten = (float)photons->traced->plan.how.flatten};
    return photon_query_of(&photons->traced->stores[c], p, &filter);
}

static bool counts(const photon_query *query, size_t i, float r2, float *distance2)
{
    *distance2 = query_distance2(&query->at, &query->points, i);
    return *distance2 < r2 && photon_query_accepts(query, i);
}

static int by_distance(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Squared distance to the k-th nearest, or where all are asked for the furthest; r2 if
   fewer lie within. */
static float nearest_radius2(const photon_query *query, size_t k, float r2)
{
    g_autoptr(GArray) found = g_array_new(FALSE, FALSE, sizeof(float));
    float distance2;
    for (size_t i = 0; i < query->store->n; i++)
        if (counts(query, i, r2, &distance2))
            g_array_append_val(found, distance2);
    g_array_sort(found, by_distance);
    if (found->len >= k)
        return g_array_index(found, float, k - 1);
    return isinf(r2) && found->len > 0 ? g_array_index(found, float, found->len - 1) : r2;
}

/* Squared radius of a class: the given one, or that which a render would gather in. */
static float radius2_of(const NephPhotons *photons, int c, double radius,
                        const photon_query *query)
{
    double own = photons->traced->statistics.radius[c];
    const settings *how = &photons->traced->plan.how;
    size_t nearest = (size_t)how->class_nearest[c] * (size_t)photons->traced->n_wholes;
    if (radius > 0.0)
        return square((float)radius);
    if (nearest == 0 || query->store->n == 0)
        return square((float)own);
    return nearest_radius2(query, nearest,
                           how->radius > 0.0 ? square((float)own) : INFINITY);
}

static void estimate_class(const NephPhotons *photons, int c, const photon_query *query,
                           float r2, NephEstimate *out)
{
    const photon_store *store = &photons->traced->stores[c];
    const settings *how = &photons->traced->plan.how;
    const kernel k = {(kernel_choice)how->class_kernel[c], (float)how->class_cone_k[c]};
    float distance2, rgb[3];
    spectrum sum = {0};
    if (!(r2 > 0.0f) || isinf(r2)) /* the nearest are asked for, and there are none */
        return;
    out->radius[c] = (double)sqrtf(r2);
    for (size_t i = 0; i < store->n; i++) {
        if (!counts(query, i, r2, &distance2))
            continue;
        sum += kernel_eval(&k, distance2, r2) * photon_store_get(store, i).flux;
        out->n[c]++;
    }
    photons_rgb(photons, sum / (kernel_area(&k, r2) * (float)photons->traced->n_wholes),
                rgb);
    for (int axis = 0; axis < 3; axis++)
        out->irradiance[c][axis] = (double)rgb[axis];
}

void neph_photons_estimate(const NephPhotons *photons, const double point[3],
                           const double normal[3], double radius, NephEstimate *out)
{
    *out = (NephEstimate){0};
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        photon_query query = query_at(photons, c, to_vec3(point), to_vec3(normal));
        estimate_class(photons, c, &query, radius2_of(photons, c, radius, &query), out);
    }
}

static int nearest_first(const void *a, const void *b)
{
    const neighbour *x = a, *y = b;
    if (x->distance2 < y->distance2 || x->distance2 > y->distance2)
        return x->distance2 < y->distance2 ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

size_t neph_photons_near(const NephPhotons *photons, const double point[3],
                         const double normal[3], double radius, size_t *index,
                         size_t capacity)
{
    g_autoptr(GArray) found = g_array_new(FALSE, FALSE, sizeof(neighbour));
    size_t offset = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        const photon_store *store = &photons->traced->stores[c];
        photon_query query = query_at(photons, c, to_vec3(point), to_vec3(normal));
        float r2 = radius2_of(photons, c, radius, &query);
        for (size_t i = 0; i < store->n; i++) {
            neighbour one = {offset + i, 0.0f};
            if (counts(&query, i, r2, &one.distance2))
                g_array_append_val(found, one);
        }
        offset += render_photons_count(photons->traced, (photon_class)c);
    }
    g_array_sort(found, nearest_first);
    for (size_t i = 0; i < MIN(capacity, found->len); i++)
        index[i] = g_array_index(found, neighbour, i).index;
    return found->len;
}
