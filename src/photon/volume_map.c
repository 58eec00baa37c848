#include "photon/volume_map.h"

#include "base/memory.h"

struct volume_map {
    photon_store owned; /* empty: they are another map's */
    const photon_store *store;
    disc *discs;
    disc_set *set;
};

/* Without what the discs are. NULL when memory is refused; what is owned is taken. */
static volume_map *make(photon_store *owned, const photon_store *lent, GError **error)
{
    volume_map *map = g_new0(volume_map, 1);
    if (owned) {
        map->owned = *owned;
        *owned = (photon_store){0};
    }
    map->store = lent ? lent : &map->owned;
    map->discs = big_alloc(map->store->n, sizeof *map->discs, "photons in media", error);
    if (map->discs)
        return map;
    volume_map_free(map);
    return NULL;
}

static volume_map *with_set(volume_map *map, unsigned threads, GError **error)
{
    map->set = disc_set_build(map->discs, map->store->n, threads, error);
    if (map->set)
        return map;
    volume_map_free(map);
    return NULL;
}

volume_map *volume_map_build(photon_store *store, const float *radii, unsigned threads,
                             GError **error)
{
    volume_map *map = make(store, NULL, error);
    if (!map)
        return NULL;
    const photon_store *s = map->store;
    for (size_t i = 0; i < s->n; i++)
        map->discs[i] = (disc){s->x[i], s->y[i], s->z[i], radii[i]};
    return with_set(map, threads, error);
}

volume_map *volume_map_widened(const volume_map *map, float by, unsigned threads,
                               GError **error)
{
    volume_map *wide = make(NULL, map->store, error);
    if (!wide)
        return NULL;
    for (size_t i = 0; i < map->store->n; i++) {
        wide->discs[i] = map->discs[i];
        wide->discs[i].radius *= by;
    }
    return with_set(wide, threads, error);
}

void volume_map_free(volume_map *map)
{
    if (!map)
        return;
    disc_set_free(map->set);
    big_free(map->discs);
    photon_store_clear(&map->owned);
    g_free(map);
}

const photon_store *volume_map_store(const volume_map *map)
{
    return map->store;
}

size_t volume_map_bytes(const volume_map *map)
{
    return photon_store_bytes(&map->owned) + map->store->n * sizeof *map->discs;
}

/* e^(-σt t), in one go where all wavelengths have the same σt. */
static spectrum transmittance_over(spectrum sigma_t, bool is_grey, float t)
{
    return is_grey ? spectrum_fill(expf(-sigma_t[0] * t))
                   : transmittance_after(sigma_t, t);
}

static bool all_alike(spectrum s)
{
    for (int i = 1; i < N_WAVELENGTHS; i++)
        if (s[i] < s[0] || s[i] > s[0])
            return false;
    return true;
}

spectrum volume_map_radiance(const volume_map *map, const volume_query *query,
                             bool *failed)
{
    const medium *m = query->medium;
    const photon_store *store = map->store;
    spectrum sum = {0}, sigma_t = medium_extinction(m, query->w);
    bool is_grey = all_alike(sigma_t);
    ray r = *query->ray;
    r.t_max = query->length;
    for (size_t i = 0; i < query->n_groups; i++)
        query->groups[i] = (spectrum){0};
    if (!disc_set_cross(map->set, &r, query->crossings))
        *failed = true;
    for (size_t i = 0; i < query->crossings->n; i++) {
        const disc_crossing *at = &query->crossings->at[i];
        if (store->home[at->index] != medium_home(m))
            continue;
        float r2 = map->discs[at->index].radius * map->discs[at->index].radius;
        float phase = phase_henyey_greenstein(
            m->g, -dot3(r.direction, direction_unpack(store->wi[at->index])));
        float weight = phase * kernel_eval(&query->kernel, at->distance2, r2) /
                       kernel_area(&query->kernel, r2);
        spectrum part = transmittance_over(sigma_t, is_grey, at->t) *
                        medium_transmittance(query->solid, at->t, query->w) * weight *
                        store->flux[at->index];
        sum += part;
        if (query->n_groups > 0)
            query->groups[store->tag[at->index]] += part;
    }
    return sum;
}
