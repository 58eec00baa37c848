#include "params/sources.h"

struct scene_sources {
    GPtrArray *paths;  /* char*, ends with NULL */
    GHashTable *known; /* the same strings */
    source_func told;
    void *data;
};

scene_sources *scene_sources_new(source_func told, void *data)
{
    scene_sources *sources = g_new(scene_sources, 1);
    sources->paths = g_ptr_array_new_with_free_func(g_free);
    sources->known = g_hash_table_new(g_str_hash, g_str_equal);
    sources->told = told;
    sources->data = data;
    g_ptr_array_add(sources->paths, NULL);
    return sources;
}

void scene_sources_free(scene_sources *sources)
{
    if (!sources)
        return;
    g_hash_table_unref(sources->known);
    g_ptr_array_unref(sources->paths);
    g_free(sources);
}

void scene_sources_add(scene_sources *sources, const char *path)
{
    if (!sources)
        return;
    char *whole = g_canonicalize_filename(path, NULL);
    if (g_hash_table_contains(sources->known, whole)) {
        g_free(whole);
        return;
    }
    g_hash_table_add(sources->known, whole);
    g_ptr_array_insert(sources->paths, (int)sources->paths->len - 1, whole);
    if (sources->told)
        sources->told(whole, sources->data);
}

const char *const *scene_sources_paths(const scene_sources *sources)
{
    return (const char *const *)sources->paths->pdata;
}
