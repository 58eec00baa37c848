#include "base/parallel.h"

#include <glib.h>
#include <omp.h>

unsigned parallel_threads(unsigned n)
{
    return n ? n : g_get_num_processors();
}

bool parallel_for(size_t n, size_t chunk_size, unsigned threads,
                  const cancel_flag *cancel, parallel_body body, void *data)
{
    size_t n_chunks = (n + chunk_size - 1) / chunk_size;
    unsigned used = (unsigned)MIN((size_t)parallel_threads(threads), MAX(n_chunks, 1));
#pragma omp parallel for schedule(dynamic, 1) num_threads(used)
    for (size_t chunk = 0; chunk < n_chunks; chunk++) {
        size_t begin = chunk * chunk_size;
        if (!cancelled(cancel))
            body(begin, MIN(begin + chunk_size, n), (unsigned)omp_get_thread_num(), data);
        if (cancel && cancel->progress && omp_get_thread_num() == 0)
            cancel->progress(cancel->progress_data);
    }
    return !cancelled(cancel);
}

bool parallel_work(size_t n, size_t chunk_size, workers by, parallel_body body, void *data,
                   GError **error)
{
    if (parallel_for(n, chunk_size, by.threads, by.cancel, body, data))
        return true;
    error_set(error, ERROR_CANCELLED, "cancelled");
    return false;
}
