/*
 * The table of settings: each knob's name, type, unit, range, default and sentence, once.
 */
#include "settings/settings_table.h"

#include "base/words.h"

#include <string.h>

static const char *const integrator_words[] = {
#define INTEGRATOR(choice, word) #word,
#include "settings/integrator.def"
#undef INTEGRATOR
    "sppm", NULL};
static const char *const kernel_words[] = {
#define KERNEL(choice, word) #word,
#include "settings/kernel.def"
#undef KERNEL
    NULL};
static const char *const map_words[] = {
#define MAP(choice, word) #word,
#include "settings/map.def"
#undef MAP
    "auto", NULL};
static const char *const window_words[] = {"auto", "fine", "coarse", NULL};
static const char *const roulette_words[] = {"mean", "max", NULL};
static const char *const emission_words[] = {"uniform", "guided", "specular-area", NULL};
static const char *const lobe_words[] = {"diffuse", "needed", "glossy", NULL};
static const char *const vcm_words[] = {"all", "bpt", "bpm", "ppm", "light", NULL};
static const char *const unlimited[] = {"unlimited", NULL};

#define AT(field) offsetof(settings, field)

static const setting_row table[] = {
    {"integrator", SETTING_CHOICE, AT(integrator), "", 0, N_INTEGRATORS - 1,
     INTEGRATOR_AUTO, integrator_words, "RENDERMODE", "all",
     "The algorithm that carries light from the lights to the eye. sppm is photonmap "
     "with "
     "spp = 1, all nearest = 0, final_gather off and alpha = 2/3: set it first. The "
     "alias "
     "is PHOTONMAP or MONTECARLO, which is path."},
    {"passes", SETTING_REAL, AT(passes), "", 0, MOST_PASSES, 0, NULL,
     "iterations numiterations", "all",
     "Independent passes whose mean is the image; 1 is classic photon mapping. Of a last "
     "fraction of a pass so many of the pixels are rendered, evenly spread. 0: as "
     "many as time and noise ask for, or 16 if neither is given."},
    {"time", SETTING_REAL, AT(time), "s", 0, 1e9, 0, NULL, "", "all",
     "The render ends then, with passes of fewer samples and photons where it is short; "
     "0: no limit. There is a picture always, if need be a coarse one."},
    {"noise", SETTING_REAL, AT(noise), "", 0, 1, 0, NULL, "", "all",
     "Stops when the relative error of the image, estimated from the scatter of its "
     "passes, is below this; 0: never."},
    {"planned_passes", SETTING_REAL, AT(planned_passes), "", 0, MOST_PASSES, 0, NULL, "",
     "all",
     "Passes that radii of indirect light and the number of photons are planned for, and "
     "whether lights are filtered as one (denoise); 0: passes, or 16 if those are not "
     "known, or what there is time for."},
    {"spp", SETTING_COUNT, AT(spp), "samples/pixel", 1, 65536, 4, NULL,
     "pixelsamples samples_per_pixel", "all", "Camera rays a pixel in each pass."},
    {"first_spp", SETTING_COUNT, AT(first_spp), "samples/pixel", 0, 65536, 0, NULL, "",
     "all",
     "Camera rays a pixel in the first pass, if fewer than spp, and photons in "
     "proportion, "
     "so that there is a picture soon; 0: spp, or where time is given 1."},
    {"max_backward_bounces", SETTING_COUNT, AT(max_backward_bounces), "", 0, 1e6, -1,
     unlimited, "maxBackwardBounces maxdepth", "all",
     "Scattering events of a path from the eye, interfaces not counted: of path, auto "
     "and vcm to the light, of photonmap and sppm to where photons are gathered, which "
     "is one. What caustic photons of auto scattered is one of them, and for the rest "
     "max_forward_bounces bounds it. Unlimited (-1): chance alone ends paths. The alias "
     "maxBackwardBounces n leaves out the gathering: n + 1. maxdepth d bounds photons "
     "too, by d - 1."},
    {"max_forward_bounces", SETTING_COUNT, AT(max_forward_bounces), "", 0, 1e6, -1,
     unlimited, "maxForwardBounces MAX_PHOTON_BOUNCES", "photonmap auto",
     "Scattering events of a photon; 0 stores it at its first hit only. Unlimited (-1): "
     "chance alone ends it. The alias maxForwardBounces n counts hits: n - 1."},
    {"final_gather", SETTING_BOOL, AT(final_gather), "", 0, 1, 0, NULL, "finalgather",
     "photonmap",
     "Gathers indirect light by rays to the surroundings instead of straight from the "
     "map."},
    {"gather_rays", SETTING_COUNT, AT(gather_rays), "", 1, 65536, 64, NULL,
     "finalgathersamples", "photonmap", "Rays of one final gather."},
    {"precompute_radiance", SETTING_BOOL, AT(precompute_radiance), "", 0, 1, 1, NULL, "",
     "photonmap",
     "Estimates radiance once at photon positions, so that a gather ray is one look-up "
     "(Christensen 1999)."},
    {"direct_illumination", SETTING_BOOL, AT(direct_illumination), "", 0, 1, 1, NULL, "",
     "photonmap auto path",
     "Samples the lights at each hit; off: direct light comes from the direct map, and "
     "paths find only lights that they meet."},
    {"shadow_rays", SETTING_BOOL, AT(shadow_rays), "", 0, 1, 1, NULL, "",
     "photonmap auto path",
     "Tests whether sampled lights are hidden; off: direct light casts no shadows."},
    {"photons", SETTING_COUNT, AT(photons), "photons/pass", 0, 1e12, 0, NULL,
     "numEmitted photonsperiteration photons_per_pass", "photonmap auto vcm",
     "Photons emitted a pass, shared among the classes that have no number of their own; "
     "0: 400000, but no more than camera paths where vcm connects them. The alias "
     "numEmitted emits them once: it sets passes to 1 too."},
    {"direct_photons", SETTING_COUNT, AT(class_photons[0]), "photons/pass", 0, 1e12, 0,
     NULL, "DIRECT_PHOTONS_PER_LIGHT directphotons", "photonmap",
     "Photons emitted a pass for the direct map; 0: a share of photons. The alias "
     "DIRECT_PHOTONS_PER_LIGHT sets passes to 1 and photons_per_light too."},
    {"indirect_photons", SETTING_COUNT, AT(class_photons[1]), "photons/pass", 0, 1e12, 0,
     NULL, "INDIRECT_PHOTONS_PER_LIGHT indirectphotons", "photonmap",
     "Photons emitted a pass for the indirect map; 0: a share of photons. The alias "
     "INDIRECT_PHOTONS_PER_LIGHT sets passes to 1 and photons_per_light too."},
    {"caustic_photons", SETTING_COUNT, AT(class_photons[2]), "photons/pass", 0, 1e12, 0,
     NULL, "CAUSTIC_PHOTONS_PER_LIGHT causticphotons", "photonmap auto",
     "Photons emitted a pass for the caustic map; 0: a share of photons. The alias "
     "CAUSTIC_PHOTONS_PER_LIGHT sets passes to 1 and photons_per_light too."},
    {"photons_per_light", SETTING_BOOL, AT(photons_per_light), "", 0, 1, 0, NULL, "",
     "photonmap",
     "The numbers of photons are those of each light, dim or bright; off: of all lights "
     "together, each getting as many as its power deserves. Where guided, photons go to "
     "the lights that the guide finds."},
    {"one_map", SETTING_BOOL, AT(one_map), "", 0, 1, 0, NULL, "", "photonmap",
     "Photons are emitted once and kept in one map, whatever they did before they landed "
     "(estimated and counted as indirect); off: a map for each class. Final gathering "
     "looks at caustics straight, and keeps the three."},
    {"photon_lobes", SETTING_CHOICE, AT(photon_lobes), "", 0, 2, PHOTON_LOBES_NEEDED,
     lobe_words, "", "photonmap",
     "Where photons are stored: on diffuse surfaces only, never on a conductor; where "
     "needed, also on glossy ones what no path from the eye finds; or on all that are no "
     "mirror, where paths from the eye then end."},
    {"photon_survivors", SETTING_BOOL, AT(photon_survivors), "", 0, 1, 0, NULL, "",
     "photonmap",
     "Only photons that survive the roulette where they land are stored there, with as "
     "much more flux; off: all."},
    {"direct_nearest", SETTING_COUNT, AT(class_nearest[0]), "photons", 2, 1e7, 0, NULL,
     "DIRECT_NEARBY_PHOTONS", "photonmap",
     "Nearest direct photons in an estimate, the last of which only tells how far it "
     "reaches; 0: all within the radius."},
    {"indirect_nearest", SETTING_COUNT, AT(class_nearest[1]), "photons", 2, 1e7, 0, NULL,
     "INDIRECT_NEARBY_PHOTONS", "photonmap",
     "Nearest indirect photons in an estimate, the last of which only tells how far it "
     "reaches; 0: all within the radius."},
    {"caustic_nearest", SETTING_COUNT, AT(class_nearest[2]), "photons", 2, 1e7, 0, NULL,
     "CAUSTIC_NEARBY_PHOTONS", "photonmap auto",
     "Nearest caustic photons in an estimate, the last of which only tells how far it "
     "reaches; 0: all within the radius."},
    {"radius", SETTING_REAL, AT(radius), "m", 0, 1e12, 0, NULL,
     "photonRadius gather_radius", "photonmap auto vcm",
     "Radius of the estimate in the first pass, or its bound for nearest photons; 0: "
     "chosen from the photons and the pixels."},
    {"one_radius", SETTING_BOOL, AT(one_radius), "", 0, 1, 0, NULL, "", "photonmap",
     "The radius chosen for a class is the same everywhere; off: larger where its "
     "photons "
     "are few."},
    {"direct_kernel", SETTING_CHOICE, AT(class_kernel[0]), "", 0, N_KERNELS - 1,
     KERNEL_EPANECHNIKOV, kernel_words, "", "photonmap",
     "How a direct photon's weight falls with distance."},
    {"indirect_kernel", SETTING_CHOICE, AT(class_kernel[1]), "", 0, N_KERNELS - 1,
     KERNEL_EPANECHNIKOV, kernel_words, "", "photonmap vcm",
     "How an indirect photon's weight falls with distance."},
    {"caustic_kernel", SETTING_CHOICE, AT(class_kernel[2]), "", 0, N_KERNELS - 1,
     KERNEL_EPANECHNIKOV, kernel_words, "", "photonmap auto",
     "How a caustic photon's weight falls with distance."},
    {"direct_cone_k", SETTING_REAL, AT(class_cone_k[0]), "", 1, 1e6, 1, NULL,
     "DIRECT_CONE_FILTER_PARAM", "photonmap",
     "Slope of the direct cone kernel 1 - d/(k r). The alias also chooses the kernel: "
     "below 1 constant, else cone."},
    {"indirect_cone_k", SETTING_REAL, AT(class_cone_k[1]), "", 1, 1e6, 1, NULL,
     "INDIRECT_CONE_FILTER_PARAM", "photonmap vcm",
     "Slope of the indirect cone kernel 1 - d/(k r). The alias also chooses the kernel: "
     "below 1 constant, else cone."},
    {"caustic_cone_k", SETTING_REAL, AT(class_cone_k[2]), "", 1, 1e6, 1, NULL,
     "CAUSTICS_CONE_FILTER_PARAM CAUSTIC_CONE_FILTER_PARAM", "photonmap auto",
     "Slope of the caustic cone kernel 1 - d/(k r). The alias also chooses the kernel: "
     "below 1 constant, else cone."},
    {"photon_map", SETTING_CHOICE, AT(photon_map), "", 0, MAP_AUTO, MAP_AUTO, map_words,
     "", "photonmap auto vcm",
     "The structure photons are looked up in; all give the same answers. auto is the "
     "tree where the automatic radius differs from place to place, else the grid."},
    {"flatten", SETTING_REAL, AT(flatten), "", 0.001, 1, 1, NULL, "",
     "photonmap auto vcm",
     "Height of the neighbourhood along the normal over its radius; below 1 it leaks "
     "less light through corners."},
    {"edges", SETTING_BOOL, AT(edges), "", 0, 1, 1, NULL, "", "photonmap auto vcm",
     "Looks at the surroundings of an estimate, so that edges and corners are not dark "
     "and no light leaks through thin walls."},
    {"bright_spots", SETTING_BOOL, AT(bright_spots), "", 0, 1, 1, NULL, "", "auto",
     "Camera paths look aside at brightly lit places, such as what the sun throws "
     "through a window, as they do at lights, where that pays."},
    {"gather_indirect", SETTING_BOOL, AT(gather_indirect), "", 0, 1, 1, NULL, "", "auto",
     "Photons carry indirect light too where trials say that a picture of the passes "
     "planned has less error so: smooth, and blurred at first. Off: paths carry it."},
    {"time_slices", SETTING_COUNT, AT(time_slices), "", 1, MOST_TIME_SLICES, 8, NULL, "",
     "photonmap auto vcm",
     "In so many parts the time of the shutter is cut where something moves: what is "
     "seen in one is lit by the photons of that one."},
    {"roulette", SETTING_CHOICE, AT(roulette), "", 0, 1, ROULETTE_MEAN, roulette_words,
     "", "photonmap auto",
     "What of a photon's flux decides its survival: the mean or the largest over "
     "wavelengths."},
    {"direct_emission", SETTING_CHOICE, AT(class_emission[0]), "", 0, EMISSION_GUIDED,
     EMISSION_GUIDED, emission_words, "", "photonmap",
     "Where direct photons are sent: as the light shines, or where trial photons landed, "
     "if that is clearly better."},
    {"indirect_emission", SETTING_CHOICE, AT(class_emission[1]), "", 0, EMISSION_GUIDED,
     EMISSION_GUIDED, emission_words, "", "photonmap auto",
     "Where indirect photons are sent: as the light shines, or where trial photons "
     "landed, such as through the window of a room, if that is clearly better."},
    {"caustic_emission", SETTING_CHOICE, AT(class_emission[2]), "", 0,
     EMISSION_SPECULAR_AREA, EMISSION_GUIDED, emission_words, "", "photonmap auto",
     "Where photons for caustics are sent: as the light shines, where trial photons were "
     "seen to cast caustics, or toward what focuses light."},
    {"multiple_samples", SETTING_BOOL, AT(multiple_samples), "", 0, 1, 1, NULL,
     "MULTIPLE_SAMPLES", "photonmap auto path",
     "Samples roughness and Fresnel's split; off: one deterministic path, without "
     "either."},
    {"vcm_strategies", SETTING_CHOICE, AT(vcm_strategies), "", 0, 4, VCM_ALL, vcm_words,
     "", "vcm",
     "How vcm finds light: by all strategies, connections only (bpt), merging at every "
     "vertex (bpm) or at the first (ppm), or light paths that reach the eye (light)."},
    {"alpha", SETTING_REAL, AT(alpha), "", 0.01, 1, 2.0 / 3.0, NULL, "",
     "photonmap auto vcm",
     "How slowly the radius shrinks from pass to pass; 1: not at all (Knaus & Zwicker "
     "2011)."},
    {"denoise", SETTING_BOOL, AT(denoise), "", 0, 1, 1, NULL, "", "all",
     "Takes the noise out of what files of eight bits and the window show; EXR "
     "files keep the picture as it is, and have this beside it as denoised.R, G and "
     "B. Auto plans for what is shown: grain that is taken out weighs less than "
     "errors of photons, which are smooth. Direct, indirect and caustic light and what "
     "mirrors show are filtered apart, or as one where fewer than two samples a pixel "
     "are planned."},
    {"denoise_windows", SETTING_CHOICE, AT(denoise_windows), "", 0, WINDOWS_COARSE,
     WINDOWS_AUTO, window_words, "", "all",
     "Around which pixels denoise works: every second (fine), or every fourth (coarse), "
     "which takes less than half of the time and errs a little more; auto: coarse where "
     "fine would take more than a tenth of the render's time, and while it goes on."},
    {"seed", SETTING_COUNT, AT(seed), "", 0, 9007199254740992.0, 0, NULL, "", "all",
     "Chooses the random numbers; the same seed gives the same image, bit for bit."},
    {"camera_seed", SETTING_COUNT, AT(camera_seed), "", 0, 9007199254740992.0, 0, NULL,
     "", "all",
     "Chooses those of paths from the eye once more, so that two pictures with the same "
     "photons need not have the same grain."},
    {"threads", SETTING_COUNT, AT(threads), "", 0, 4096, 0, NULL, "nthreads", "all",
     "Threads to work with; 0: one per processor."},
};

enum { N_ROWS = sizeof table / sizeof *table };
_Static_assert(N_ROWS <= 64, "settings.given has a bit for each");

const setting_row *settings_table(size_t *n)
{
    *n = N_ROWS;
    return table;
}

static bool is_alias(const char *aliases, const char *name)
{
    size_t length = strlen(name);
    while (*aliases) {
        size_t word = strcspn(aliases, " ");
        if (word == length && g_ascii_strncasecmp(aliases, name, word) == 0)
            return true;
        aliases += word + strspn(aliases + word, " ");
    }
    return false;
}

const setting_row *settings_find(const char *name)
{
    for (size_t i = 0; i < N_ROWS; i++)
        if (strcmp(table[i].name, name) == 0)
            return &table[i];
    for (size_t i = 0; i < N_ROWS; i++)
        if (*name && is_alias(table[i].aliases, name))
            return &table[i];
    return NULL;
}

const char *settings_nearest_name(const char *name)
{
    const char *nearest = NULL;
    size_t least = 1 + strlen(name) / 2;
    for (size_t i = 0; i < N_ROWS; i++) {
        size_t distance = edit_distance(name, table[i].name);
        if (distance < least) {
            least = distance;
            nearest = table[i].name;
        }
    }
    return nearest;
}
