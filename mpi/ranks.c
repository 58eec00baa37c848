#include "ranks.h"

#include "message.h"

#include <math.h>
#include <string.h>

int ranks_me(void)
{
    int me;
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    return me;
}

int ranks_count(void)
{
    int n;
    MPI_Comm_size(MPI_COMM_WORLD, &n);
    return n;
}

/* All ranks call it: of this rank's machine. */
static double sum_here(double number)
{
    MPI_Comm here;
    double sum;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Allreduce(&number, &sum, 1, MPI_DOUBLE, MPI_SUM, here);
    MPI_Comm_free(&here);
    return sum;
}

int ranks_threads(void)
{
    return MAX((int)g_get_num_processors() / (int)sum_here(1.0), 1);
}

double ranks_crowd(double threads)
{
    double processors = (double)g_get_num_processors();
    return fmax(sum_here(threads > 0.0 ? threads : processors) / processors, 1.0);
}

enum { LONGEST_PAUSE = 1000 }; /* µs */

void ranks_wait(MPI_Request *request)
{
    int done = 0;
    for (gulong pause = 1; MPI_Test(request, &done, MPI_STATUS_IGNORE), !done;
         pause = MIN(2 * pause, LONGEST_PAUSE))
        g_usleep(pause);
}

void ranks_share(void *data, int n, MPI_Datatype type)
{
    MPI_Request request;
    MPI_Ibcast(data, n, type, ROOT, MPI_COMM_WORLD, &request);
    ranks_wait(&request);
}

/* In pieces whose sizes MPI can say. */
static void share_bytes(char *data, uint64_t size)
{
    const uint64_t piece = 1 << 30;
    for (uint64_t done = 0; done < size; done += piece)
        ranks_share(data + done, (int)MIN(size - done, piece), MPI_CHAR);
}

GBytes *ranks_share_bytes(GBytes *bytes)
{
    gsize size = 0;
    const void *mine = bytes ? g_bytes_get_data(bytes, &size) : NULL;
    uint64_t all = size;
    ranks_share(&all, 1, MPI_UINT64_T);
    char *out = g_malloc0(all + 1);
    if (mine)
        memcpy(out, mine, all);
    share_bytes(out, all);
    return g_bytes_new_take(out, all);
}

char *ranks_share_text(const char *text)
{
    g_autoptr(GBytes) mine = text ? g_bytes_new(text, strlen(text) + 1) : NULL;
    g_autoptr(GBytes) all = ranks_share_bytes(mine);
    return g_strdup(g_bytes_get_data(all, NULL));
}

bool ranks_agree(bool well)
{
    int mine = well, all;
    MPI_Request request;
    MPI_Iallreduce(&mine, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD, &request);
    ranks_wait(&request);
    return all;
}

_Noreturn void ranks_abort(const GError *error)
{
    tell("error", "rank %d of %d: %s", ranks_me(), ranks_count(), error->message);
    MPI_Abort(MPI_COMM_WORLD, error->code);
    g_abort();
}
