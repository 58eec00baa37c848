/*
 * The photons around a point, and the estimate they make: the naive way, one look at each
 * photon, since nobody asks for it more than once a click.
 *
 *   E = Σ κ(d) Φ / ∫∫ κ(s) s ds dθ      over photons on surfaces within r, arrived
 * on the normal's side
 */
#include "api/photons.h"

#include "photon/kernel.h"

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

static float radius_of(const NephPhotons *photons, double radius, int c)
{
    double own = photons->traced->statistics.radius[c];
    return (float)(radius > 0.0 ? radius : own);
}

/* True if photon i of the store counts for a disc or ball of radius r around p. */
static bool counts(const photon_store *store, size_t i, vec3 p, vec3 n, float r,
                   float *distance2)
{
    vec3 d = vec3_make(store->x[i], store->y[i], store->z[i]) - p;
    *distance2 = dot3(d, d);
    return *distance2 < r * r && dot3(direction_unpack(store->wi[i]), n) > 0.0f;
}

static void estimate_class(const NephPhotons *photons, int c, vec3 p, vec3 n,
                           NephEstimate *out)
{
    const photon_store *store = &photons->traced->stores[c];
    const settings *how = &photons->traced->plan.how;
    const kernel k = {(kernel_choice)how->class_kernel[c], (float)how->class_cone_k[c]};
    float r = (float)out->radius[c], distance2, rgb[3];
    spectrum sum = {0};
    if (!(r > 0.0f))
        return;
    for (size_t i = 0; i < store->n; i++) {
        if (!counts(store, i, p, n, r, &distance2))
            continue;
        sum += kernel_eval(&k, distance2, r * r) * photon_store_get(store, i).flux;
        out->n[c]++;
    }
    photons_rgb(photons, sum / kernel_area(&k, r * r), rgb);
    for (int axis = 0; axis < 3; axis++)
        out->irradiance[c][axis] = (double)rgb[axis];
}

void neph_photons_estimate(const NephPhotons *photons, const double point[3],
                           const double normal[3], double radius, NephEstimate *out)
{
    *out = (NephEstimate){0};
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        out->radius[c] = (double)radius_of(photons, radius, c);
        estimate_class(photons, c, to_vec3(point), to_vec3(normal), out);
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
    vec3 p = to_vec3(point), n = to_vec3(normal);
    size_t offset = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        const photon_store *store = &photons->traced->stores[c];
        float r = radius_of(photons, radius, c);
        for (size_t i = 0; i < store->n; i++) {
            neighbour one = {offset + i, 0.0f};
            if (counts(store, i, p, n, r, &one.distance2))
                g_array_append_val(found, one);
        }
        offset += render_photons_count(photons->traced, (photon_class)c);
    }
    g_array_sort(found, nearest_first);
    for (size_t i = 0; i < MIN(capacity, found->len); i++)
        index[i] = g_array_index(found, neighbour, i).index;
    return found->len;
}
