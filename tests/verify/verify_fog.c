/*
 * Fog in photon maps: views of known radiance (fog_views.h). Near the boundary of a
 * medium an estimate from discs loses what reaches over it, in proportion to the radius;
 * so radii are small, and the views, each of one ray, need many photons.
 */
#include "fog_views.h"

static const method absorbing_ways[] = {
    {"photonmap", "integrator=photonmap spp=4 passes=16 photons=20000", 0},
    {"sppm", "integrator=sppm passes=32 photons=20000", 0},
};

static const method scattering_ways[] = {
    {"photonmap",
     "integrator=photonmap spp=1 passes=24 photons=120000 radius=.07 alpha=1", 0},
    {"sppm", "integrator=sppm passes=24 photons=120000 radius=.08", 0},
};

static const method furnace_ways[] = {
    {"photonmap",
     "integrator=photonmap spp=4 passes=16 photons=40000 radius=.03 alpha=1 "
     "max_backward_bounces=-1",
     0.03},
    {"sppm", "integrator=sppm passes=48 photons=20000 radius=.05 max_backward_bounces=-1",
     0.03},
};

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    add_views("absorbs", absorbing, G_N_ELEMENTS(absorbing), 0.005, absorbing_ways, 2);
    add_views("scatters", scattering, G_N_ELEMENTS(scattering), 0.07, scattering_ways, 2);
    add_views("furnace", furnaces, G_N_ELEMENTS(furnaces), 0.02, furnace_ways, 2);
    return g_test_run();
}
