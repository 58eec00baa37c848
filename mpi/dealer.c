#include "dealer.h"

#include "ranks.h"

enum { TAG_ASK = 1, TAG_ORDER, TAG_GIVE_UP };
enum {
    PAUSE = 500
}; /* µs between looks at who asks, where there is nothing else to do */

order dealer_deal(dealer *d, int n_before)
{
    d->joining = d->joining || d->is_due(n_before, d->data);
    d->n_told += d->joining;
    return (order){d->joining ? -1 : d->next++};
}

static void answer(dealer *d, const MPI_Status *from)
{
    rank_news what;
    MPI_Recv(&what, (int)sizeof what, MPI_BYTE, from->MPI_SOURCE, TAG_ASK, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    if (what.last_pass > 0.0)
        d->hear(what.last_pass, d->data);
    const order next = dealer_deal(d, (int)what.n_before);
    MPI_Send(&next.pass, 1, MPI_INT64_T, from->MPI_SOURCE, TAG_ORDER, MPI_COMM_WORLD);
}

void dealer_serve(dealer *d)
{
    int asks = 0;
    MPI_Status from;
    for (;;) {
        MPI_Iprobe(MPI_ANY_SOURCE, TAG_ASK, MPI_COMM_WORLD, &asks, &from);
        if (!asks)
            return;
        answer(d, &from);
    }
}

bool dealer_all_know(dealer *d)
{
    dealer_serve(d);
    bool all = d->n_told == ranks_count();
    if (all) {
        d->n_told = 0;
        d->joining = false;
    } else
        g_usleep(PAUSE);
    return all;
}

void dealer_give_up(dealer *d)
{
    const char nothing = 0;
    for (int rank = 0; rank < ranks_count() && !d->gave_up; rank++)
        if (rank != ROOT)
            MPI_Send(&nothing, 1, MPI_CHAR, rank, TAG_GIVE_UP, MPI_COMM_WORLD);
    d->gave_up = d->joining = true;
}

bool dealer_says_give_up(void)
{
    int says;
    MPI_Iprobe(ROOT, TAG_GIVE_UP, MPI_COMM_WORLD, &says, MPI_STATUS_IGNORE);
    return says;
}

bool dealer_settle(dealer *d)
{
    int gave_up = d->gave_up;
    char nothing;
    ranks_share(&gave_up, 1, MPI_INT);
    if (gave_up && ranks_me() != ROOT)
        MPI_Recv(&nothing, 1, MPI_CHAR, ROOT, TAG_GIVE_UP, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
    d->gave_up = false;
    return gave_up;
}

question *question_ask(int n_before, double last_pass)
{
    question *q = g_new0(question, 1);
    q->what = (rank_news){.n_before = n_before, .last_pass = last_pass};
    MPI_Isend(&q->what, (int)sizeof q->what, MPI_BYTE, ROOT, TAG_ASK, MPI_COMM_WORLD,
              &q->sent);
    MPI_Irecv(&q->pass, 1, MPI_INT64_T, ROOT, TAG_ORDER, MPI_COMM_WORLD, &q->answered);
    return q;
}

order question_answer(question *q)
{
    ranks_wait(&q->sent);
    ranks_wait(&q->answered);
    const order next = {q->pass};
    g_free(q);
    return next;
}
