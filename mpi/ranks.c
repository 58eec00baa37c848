#include "ranks.h"

#include "message.h"

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

int ranks_threads(void)
{
    MPI_Comm here;
    int n, processors = (int)g_get_num_processors();
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &n);
    MPI_Comm_free(&here);
    return MAX(processors / n, 1);
}

/* In pieces whose sizes MPI can say. */
static void share(char *data, uint64_t size)
{
    const uint64_t piece = 1 << 30;
    for (uint64_t done = 0; done < size; done += piece)
        MPI_Bcast(data + done, (int)MIN(size - done, piece), MPI_CHAR, ROOT,
                  MPI_COMM_WORLD);
}

GBytes *ranks_share_bytes(GBytes *bytes)
{
    gsize size = 0;
    const void *mine = bytes ? g_bytes_get_data(bytes, &size) : NULL;
    uint64_t all = size;
    MPI_Bcast(&all, 1, MPI_UINT64_T, ROOT, MPI_COMM_WORLD);
    char *out = g_malloc0(all + 1);
    if (mine)
        memcpy(out, mine, all);
    share(out, all);
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
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all;
}

_Noreturn void ranks_abort(const GError *error)
{
    tell("error", "rank %d of %d: %s", ranks_me(), ranks_count(), error->message);
    MPI_Abort(MPI_COMM_WORLD, error->code);
    g_abort();
}
