/*
 * The photon store, and directions in 30 bits.
 *
 * Directions are octahedral (Meyer et al. 2010; Cigolle et al., "A Survey of Efficient
 * Representations for Independent Unit Vectors", JCGT 2014): the sphere is projected to
 * |x| + |y| + |z| = 1, the lower half folded out over the upper, and the square that
 * results cut into 32767 steps a side: an odd number, so that the axes are exact. Of the
 * four grid points around a direction the nearest on the sphere is taken, which brings
 * the largest error from 1.3e-4 to 8.6e-5 rad and centres it.
 */
#include "photon/photon.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "math/sampler.h"
#include "photon/direction.h"

static bool grow(void *array, size_t n, size_t capacity, size_t size, GError **error)
{
    void *old = *(void **)array;
    void *grown = big_grow(old, n, capacity, size, "photons", error);
    if (grown)
        *(void **)array = grown;
    return grown != NULL;
}

static void free_arrays(photon_store *store)
{
    big_free(store->x);
    big_free(store->y);
    big_free(store->z);
    big_free(store->wi);
    big_free(store->flux);
    big_free(store->packed);
    big_free(store->normal);
    big_free(store->tag);
    big_free(store->home);
    big_free(store->number);
    *store = (photon_store){.oriented = store->oriented,
                            .tagged = store->tagged,
                            .homed = store->homed,
                            .numbered = store->numbered};
}

bool photon_store_reserve(photon_store *store, size_t capacity, GError **error)
{
    if (store->x && capacity <= store->capacity)
        return true;
    if (capacity > SIZE_MAX / (4 * sizeof(photon))) {
        error_set(error, ERROR_FAILED, "out of memory: %zu photons", capacity);
        return false;
    }
    size_t n = store->n, room = points_padded(capacity);
    bool ok =
        grow(&store->x, n, room, sizeof *store->x, error) &&
        grow(&store->y, n, room, sizeof *store->y, error) &&
        grow(&store->z, n, room, sizeof *store->z, error) &&
        grow(&store->wi, n, room, sizeof *store->wi, error) &&
        (store->numbered ? grow(&store->number, n, room, sizeof *store->number, error)
                         : grow(&store->flux, n, room, sizeof *store->flux, error)) &&
        (!store->oriented ||
         grow(&store->normal, n, room, sizeof *store->normal, error)) &&
        (!store->tagged || grow(&store->tag, n, room, sizeof *store->tag, error)) &&
        (!store->homed || grow(&store->home, n, room, sizeof *store->home, error));
    if (ok)
        store->capacity = room - points_padded(0);
    else if (store->capacity == 0)
        free_arrays(store);
    return ok;
}

void photon_store_put(photon_store *store, const photon *p)
{
    photon_store_set(store, store->n++, p);
}

packed_photon photon_store_packed(const photon_store *store, const photon *p)
{
    return (packed_photon){
        .flux = p->flux,
        .p = {p->p[0], p->p[1], p->p[2]},
        .wi = direction_pack(p->wi, p->flags),
        .normal = store->oriented ? direction_pack(p->n, 0) : 0,
        .tag = p->tag,
        .home = p->home,
    };
}

void photon_store_set_packed(photon_store *store, size_t i, const packed_photon *p)
{
    store->x[i] = p->p[0];
    store->y[i] = p->p[1];
    store->z[i] = p->p[2];
    store->wi[i] = p->wi;
    if (!store->numbered)
        store->flux[i] = p->flux;
    if (store->oriented)
        store->normal[i] = p->normal;
    if (store->tagged)
        store->tag[i] = p->tag;
    if (store->homed)
        store->home[i] = p->home;
}

void photon_store_set(photon_store *store, size_t i, const photon *p)
{
    const packed_photon packed = photon_store_packed(store, p);
    photon_store_set_packed(store, i, &packed);
    if (store->numbered)
        store->number[i] = p->number;
}

photon photon_store_get(const photon_store *store, size_t i)
{
    return (photon){
        .p = vec3_make(store->x[i], store->y[i], store->z[i]),
        .wi = direction_unpack(store->wi[i]),
        .flux = store->numbered ? (spectrum){0} : photon_store_flux(store, i),
        .flags = direction_flags(store->wi[i]),
        .n = store->oriented ? direction_unpack(store->normal[i]) : (vec3){0},
        .tag = store->tagged ? store->tag[i] : 0,
        .home = store->homed ? store->home[i] : 0,
        .number = store->numbered ? store->number[i] : 0,
    };
}

void photon_store_clear(photon_store *store)
{
    free_arrays(store);
    *store = (photon_store){0};
}

void photon_store_copy(const photon_store *to, size_t at, const photon_store *from)
{
    size_t n = from->n;
    if (n == 0)
        return;
    memcpy(to->x + at, from->x, n * sizeof *from->x);
    memcpy(to->y + at, from->y, n * sizeof *from->y);
    memcpy(to->z + at, from->z, n * sizeof *from->z);
    memcpy(to->wi + at, from->wi, n * sizeof *from->wi);
    if (to->numbered)
        memcpy(to->number + at, from->number, n * sizeof *from->number);
    else
        memcpy(to->flux + at, from->flux, n * sizeof *from->flux);
    if (to->oriented)
        memcpy(to->normal + at, from->normal, n * sizeof *from->normal);
    if (to->tagged)
        memcpy(to->tag + at, from->tag, n * sizeof *from->tag);
    if (to->homed)
        memcpy(to->home + at, from->home, n * sizeof *from->home);
}

size_t photon_store_bytes(const photon_store *store)
{
    size_t each = 3 * sizeof(float) + sizeof(uint32_t);
    each += store->numbered ? sizeof(size_t)
            : store->packed ? sizeof *store->packed
                            : sizeof *store->flux;
    each += store->oriented ? sizeof(uint32_t) : 0;
    each += store->tagged ? sizeof(uint32_t) : 0;
    each += store->homed ? sizeof(uint32_t) : 0;
    return store->x ? (store->capacity + points_padded(0)) * each : 0;
}

/* Flux being packed: to[i] is what was from[order[i]]. */
typedef struct packing {
    const spectrum *from;
    packed_flux *to;
    const size_t *order; /* NULL: as it stands */
} packing;

static void pack_piece(size_t begin, size_t end, unsigned thread, void *data)
{
    enum { AHEAD = 16 }; /* size: photons on their way from memory */
    (void)thread;
    const packing *job = data;
    const size_t *order = job->order;
    for (size_t i = begin; i < end; i++) {
        size_t k = order ? order[i] : i; /* alike in every order */
        if (order && i + AHEAD < end)
            __builtin_prefetch(job->from + order[i + AHEAD]);
        flux_pack(job->from[k], hash_mix(k, N_WAVELENGTHS), &job->to[i]);
    }
}

/* In this order, too. */
static bool pack_flux(photon_store *store, const size_t *order, workers by,
                      GError **error)
{
    packing job = {store->flux, NULL, order};
    job.to = big_alloc(points_padded(store->n), sizeof *job.to, "photons", error);
    if (!job.to)
        return false;
    if (!parallel_work(store->n, ITEMS_AT_ONCE, by, pack_piece, &job, error)) {
        big_free(job.to);
        return false;
    }
    big_free(store->flux);
    store->flux = NULL;
    store->packed = job.to;
    return true;
}

bool photon_store_follow(photon_store *store, const size_t *order, workers by,
                         GError **error)
{
    const struct {
        void *array;
        size_t size;
        bool kept;
    } all[] = {
        {&store->wi, sizeof *store->wi, true},
        {&store->number, sizeof *store->number, store->numbered},
        {&store->normal, sizeof *store->normal, store->oriented},
        {&store->tag, sizeof *store->tag, store->tagged},
        {&store->home, sizeof *store->home, store->homed},
    };
    if (store->flux && !pack_flux(store, order, by, error))
        return false;
    if (!order)
        return true;
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        if (all[i].kept &&
            !points_permute(all[i].array, store->n, all[i].size, order, by, error))
            return false;
    store->capacity = points_padded(store->n) - points_padded(0);
    return true;
}

/* The grid point (u, v), steps from the centre, with its flags. */
static uint32_t pack_steps(int u, int v, unsigned flags)
{
    return (uint32_t)(u + OCTAHEDRON_STEPS) | (uint32_t)(v + OCTAHEDRON_STEPS) << 15 |
           (uint32_t)flags << 30;
}

static floats4 clamp_steps(floats4 x)
{
    const float end = (float)OCTAHEDRON_STEPS;
    return max3(min3(x, (floats4){end, end, end, end}), -(floats4){end, end, end, end});
}

/* Squared sine, times |w|², of the angle between w and each of four grid points. The
   points are computed as direction_octahedron does, in floats: exact all the same. */
static floats4 squared_sines(floats4 u, floats4 v, vec3 w)
{
    const vec3_bits sign = (vec3_bits){0} + INT32_MIN;
    floats4 z = (float)OCTAHEDRON_STEPS - abs3(u) - abs3(v);
    vec3_bits fold = (vec3_bits)max3(-z, (floats4){0});
    floats4 x = u - (floats4)(fold | ((vec3_bits)u & sign));
    floats4 y = v - (floats4)(fold | ((vec3_bits)v & sign));
    floats4 a = y * w[2] - z * w[1], b = z * w[0] - x * w[2], c = x * w[1] - y * w[0];
    return (a * a + b * b + c * c) / (x * x + y * y + z * z);
}

uint32_t direction_pack(vec3 w, unsigned flags)
{
    float norm = fabsf(w[0]) + fabsf(w[1]) + fabsf(w[2]);
    vec3 o = w * ((float)OCTAHEDRON_STEPS / norm);
    float u = o[0], v = o[1];
    if (o[2] < 0.0f) {
        u = copysignf((float)OCTAHEDRON_STEPS - fabsf(o[1]), o[0]);
        v = copysignf((float)OCTAHEDRON_STEPS - fabsf(o[0]), o[1]);
    }
    floats4 us = clamp_steps(floorf(u) + (floats4){0.0f, 1.0f, 0.0f, 1.0f});
    floats4 vs = clamp_steps(floorf(v) + (floats4){0.0f, 0.0f, 1.0f, 1.0f});
    floats4 sine2 = squared_sines(us, vs, w);
    int best = 0;
    for (int corner = 1; corner < 4; corner++)
        best = sine2[corner] < sine2[best] ? corner : best;
    return pack_steps((int)us[best], (int)vs[best], flags);
}

vec3 direction_unpack(uint32_t packed)
{
    return normalize3(direction_octahedron(packed));
}
