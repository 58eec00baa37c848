#include "join.h"

#include "clock.h"
#include "ranks.h"

#include <math.h>

/* Numbers in a message: so that a film of any size is sent with little memory beside it.
 */
enum { PIECE = 1 << 19 };

enum { TRIALS = 3 };

/* What of the statistics is added up, as 64-bit counts and seconds. */
static void join_counts(NephRender *render)
{
    enum { N_COUNTS = 5 + 2 * NEPH_N_PHOTON_CLASSES, N_TIMES = 4 };
    NephStatistics s = {0}, all = {0};
    if (ranks_me() != ROOT)
        neph_render_statistics(render, &s);
    uint64_t counts[N_COUNTS] = {(uint64_t)s.passes, s.photon_rays, s.camera_rays,
                                 s.shadow_rays, s.n_not_finite};
    double times[N_TIMES] = {s.time_trace, s.time_build, s.time_gather, s.time_camera};
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        counts[5 + c] = s.emitted[c];
        counts[5 + NEPH_N_PHOTON_CLASSES + c] = s.stored[c];
    }
    uint64_t sum[N_COUNTS];
    double seconds[N_TIMES];
    MPI_Reduce(counts, sum, N_COUNTS, MPI_UINT64_T, MPI_SUM, ROOT, MPI_COMM_WORLD);
    MPI_Reduce(times, seconds, N_TIMES, MPI_DOUBLE, MPI_SUM, ROOT, MPI_COMM_WORLD);
    if (ranks_me() != ROOT)
        return;
    all = (NephStatistics){.passes = (int64_t)sum[0],
                           .photon_rays = sum[1],
                           .camera_rays = sum[2],
                           .shadow_rays = sum[3],
                           .n_not_finite = sum[4],
                           .time_trace = seconds[0],
                           .time_build = seconds[1],
                           .time_gather = seconds[2],
                           .time_camera = seconds[3]};
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        all.emitted[c] = sum[5 + c];
        all.stored[c] = sum[5 + NEPH_N_PHOTON_CLASSES + c];
    }
    neph_render_add_statistics(render, &all);
}

/* Numbers [first, first + some) of all ranks. */
static void join_some(NephRender *render, size_t first, size_t some, double *own,
                      double *all)
{
    if (ranks_me() != ROOT) /* the root has its own in place */
        neph_render_get_sums(render, first, some, own);
    MPI_Reduce(own, all, (int)some, MPI_DOUBLE, MPI_SUM, ROOT, MPI_COMM_WORLD);
    if (ranks_me() == ROOT)
        neph_render_add_sums(render, first, some, all);
}

void join_sums(NephRender *render)
{
    size_t n = neph_render_count_sums(render);
    g_autofree double *own = g_new0(double, PIECE), *all = g_new(double, PIECE);
    for (size_t first = 0; first < n; first += PIECE)
        join_some(render, first, MIN(n - first, (size_t)PIECE), own, all);
    join_counts(render);
    if (ranks_me() != ROOT)
        neph_render_forget(render);
}

double join_seconds(NephRender *render)
{
    size_t n = neph_render_count_sums(render), some = MIN(n, (size_t)PIECE);
    g_autofree double *own = g_new0(double, PIECE), *all = g_new(double, PIECE);
    double took = 0.0;
    for (int i = 0; i < TRIALS; i++) { /* the first one makes the ranks' ways ready */
        double start = clock_now();
        join_some(render, 0, some, own, all);
        took = i > 0 ? fmax(took, clock_now() - start) : 0.0;
    }
    return took * (double)n / (double)some;
}
