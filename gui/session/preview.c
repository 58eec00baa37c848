#include "session/preview.h"

#include <math.h>

/* Pixels of the very first look. */
enum { FIRST_PIXELS = 9600, LEAST_PIXELS = 1200 };

/* Share of the scene's diagonal within which photons are gathered. */
#define GATHER_SHARE 0.03

NephSettings *preview_settings(const NephSettings *wanted, double extent)
{
    static const char *const quick[][2] = {
        {"passes", "1"},
        {"time", "0"},
        {"noise", "0"},
        {"spp", "1"},
        {"photons", "8000"},
        {"final_gather", "false"},
        {"direct_photons", "0"},
        {"caustic_photons", "0"},
        {"indirect_photons", "0"},
        {"direct_nearest", "0"},
        {"caustic_nearest", "0"},
        {"indirect_nearest", "0"},
        {"edges", "false"},
        {"denoise", "false"},
        {"direct_emission", "uniform"},
        {"indirect_emission", "uniform"},
        {"caustic_emission", "specular-area"},
    };
    NephSettings *s = neph_settings_copy(wanted);
    /* What sends photons is seen soonest by few of them. */
    if (neph_settings_reads(s, "photons"))
        neph_settings_set(s, "integrator", "photonmap", NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(quick); i++)
        neph_settings_set(s, quick[i][0], quick[i][1], NULL);
    char radius[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_dtostr(radius, sizeof radius, GATHER_SHARE * extent);
    if (extent > 0.0)
        neph_settings_set(s, "radius", radius, NULL);
    return s;
}

void preview_size(const preview_pace *pace, double seconds, const int whole[2],
                  int size[2])
{
    double pixels =
        pace->pixels_per_second > 0.0 ? pace->pixels_per_second * seconds : FIRST_PIXELS;
    double all = (double)whole[0] * (double)whole[1];
    double side = fmin(1.0, sqrt(fmax(pixels, LEAST_PIXELS) / all));
    for (int i = 0; i < 2; i++)
        size[i] = (int)fmax(1.0, rint(side * whole[i]));
}

void preview_note(preview_pace *pace, const int size[2], double seconds)
{
    pace->pixels_per_second = (double)size[0] * (double)size[1] / fmax(seconds, 1e-3);
}
