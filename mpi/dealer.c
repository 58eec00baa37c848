#include "dealer.h"

#include "ranks.h"

enum { TAG_ASK = 1, TAG_ORDER };

order dealer_deal(dealer *d)
{
    d->joining = d->joining || d->is_due(d->data);
    d->n_told += d->joining;
    return (order){d->joining ? -1 : d->next++};
}

static void answer(dealer *d, const MPI_Status *from)
{
    int64_t nothing;
    MPI_Recv(&nothing, 1, MPI_INT64_T, from->MPI_SOURCE, TAG_ASK, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    const order next = dealer_deal(d);
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

void dealer_wait(dealer *d)
{
    MPI_Status from;
    while (d->n_told < ranks_count()) {
        MPI_Probe(MPI_ANY_SOURCE, TAG_ASK, MPI_COMM_WORLD, &from);
        answer(d, &from);
    }
    d->n_told = 0;
    d->joining = false;
}

question *question_ask(void)
{
    question *q = g_new0(question, 1);
    MPI_Isend(&q->nothing, 1, MPI_INT64_T, ROOT, TAG_ASK, MPI_COMM_WORLD, &q->sent);
    MPI_Irecv(&q->pass, 1, MPI_INT64_T, ROOT, TAG_ORDER, MPI_COMM_WORLD, &q->answered);
    return q;
}

order question_answer(question *q)
{
    MPI_Wait(&q->sent, MPI_STATUS_IGNORE);
    MPI_Wait(&q->answered, MPI_STATUS_IGNORE);
    const order next = {q->pass};
    g_free(q);
    return next;
}
