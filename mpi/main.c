/*
 * nephroid-mpi: one picture by many processes, on one machine or on many.
 */
#include "command.h"
#include "job.h"
#include "message.h"
#include "ranks.h"

#include <locale.h>

int64_t program_start;

int main(int argc, char **argv)
{
    options o;
    int result = EXIT_DONE, threads;
    program_start = g_get_monotonic_time();
    setlocale(LC_CTYPE, "");
    g_set_prgname("nephroid-mpi");
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads);
    if (options_parse(&o, argc, argv, &result))
        result = job_run(&o, (double)program_start * 1e-6);
    MPI_Finalize();
    return result;
}
