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

char *ranks_share_text(const char *text)
{
    int size = text ? (int)strlen(text) : 0;
    MPI_Bcast(&size, 1, MPI_INT, ROOT, MPI_COMM_WORLD);
    char *out = g_malloc0((size_t)size + 1);
    if (text)
        memcpy(out, text, (size_t)size);
    MPI_Bcast(out, size, MPI_CHAR, ROOT, MPI_COMM_WORLD);
    return out;
}

bool ranks_agree(bool well)
{
    int mine = well, all;
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all;
}

bool ranks_same_text(const char *text)
{
    g_autofree char *of_root = ranks_share_text(ranks_me() == ROOT ? text : NULL);
    return ranks_agree(strcmp(of_root, text) == 0);
}

_Noreturn void ranks_abort(const GError *error)
{
    tell("error", "rank %d of %d: %s", ranks_me(), ranks_count(), error->message);
    MPI_Abort(MPI_COMM_WORLD, error->code);
    g_abort();
}
