#include "photon/looked_around.h"

#include "photon/photon_query.h"

looked_disc disc_look(const neighbourhood *disc, const kernel *k)
{
    looked_disc out = {.hood = *disc, .kernel = *k, .coverage = 1.0f};
    out.whole = neighbourhood_is_whole(&out.hood);
    if (!out.whole)
        out.coverage = neighbourhood_coverage(&out.hood, k);
    return out;
}

/* What lies off the plane is another surface, as beneath the edge of a table. */
static bool is_beside(const neighbourhood *a, const neighbourhood *b)
{
    vec3 off = b->p - a->p;
    float reach = SHARED_REACH * a->radius, cosine = dot3(a->n, b->n);
    return length3_2(off) <= reach * reach &&
           fabsf(dot3(off, a->n)) <= NEIGHBOURHOOD_FLATTEN * a->radius && cosine > 0.0f &&
           cosine * cosine > SAME_SURFACE;
}

/* A wall between two discs hides from one what is in sight of the other. */
static bool is_seen(const looked_disc *by, vec3 p)
{
    return by->whole || neighbourhood_sees(&by->hood, p);
}

const looked_disc *looked_around_find(const looked_around *looked,
                                      const neighbourhood *disc, const kernel *k)
{
    for (unsigned i = 0; i < MIN(looked->n, LOOKED_DISCS); i++) {
        const looked_disc *seen = &looked->discs[i];
        if (seen->hood.radius == disc->radius && seen->hood.time == disc->time &&
            seen->kernel.choice == k->choice && seen->kernel.cone_k == k->cone_k &&
            is_beside(&seen->hood, disc) && is_seen(seen, disc->p))
            return seen;
    }
    return NULL;
}

void looked_around_put(looked_around *looked, const looked_disc *disc)
{
    looked->discs[looked->n++ % LOOKED_DISCS] = *disc;
}
