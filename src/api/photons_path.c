/*
 * One photon's life, told again: tracing is a pure function of the photon's number.
 */
#include "api/photons.h"

#include <string.h>

_Static_assert(NEPH_PHOTON_EMITTED == (int)PHOTON_EMITTED, "kinds are one list");
_Static_assert(NEPH_PHOTON_STORED == (int)PHOTON_STORED, "kinds are one list");
_Static_assert(NEPH_PHOTON_SCATTERED == (int)PHOTON_SCATTERED, "kinds are one list");
_Static_assert(NEPH_PHOTON_ABSORBED == (int)PHOTON_ABSORBED, "kinds are one list");
_Static_assert(NEPH_PHOTON_ENDED == (int)PHOTON_ENDED, "kinds are one list");
_Static_assert(NEPH_PHOTON_LEFT == (int)PHOTON_LEFT, "kinds are one list");

typedef struct path_teller {
    const NephPhotons *photons;
    NephPhotonEvent *events;
    size_t n, capacity;
} path_teller;

static const char *scattering(unsigned lobe)
{
    static const char *const words[3][2] = {
        {"diffuse reflected", "diffuse transmitted"},
        {"glossy reflected", "glossy transmitted"},
        {"specular reflected", "specular transmitted"}};
    int kind = lobe & LOBE_SPECULAR ? 2 : lobe & LOBE_GLOSSY ? 1 : 0;
    return words[kind][lobe & LOBE_TRANSMISSION ? 1 : 0];
}

static const char *what_of(const photon_event *event)
{
    static const char *const words[] = {
        [PHOTON_EMITTED] = "emitted",   [PHOTON_STORED] = "stored",
        [PHOTON_ABSORBED] = "absorbed", [PHOTON_ENDED] = "ended",
        [PHOTON_LEFT] = "left",
    };
    if (event->kind != PHOTON_SCATTERED)
        return words[event->kind];
    return event->hit->shape == NO_INDEX ? "scattered" : scattering(event->lobe);
}

static const char *material_of(const scene *s, const photon_event *event)
{
    if (!event->hit)
        return event->kind == PHOTON_EMITTED ? scene_light(s, event->light)->kind->name
                                             : "";
    if (event->hit->shape == NO_INDEX)
        return scene_medium(s, event->hit->media.participating)->name;
    if (event->hit->material == NO_INDEX)
        return "";
    const material *m = s->materials->pdata[event->hit->material];
    return m->name ? m->name : m->kind->name;
}

static void tell(const photon_event *event, void *data)
{
    path_teller *teller = data;
    size_t i = teller->n++;
    if (i >= teller->capacity)
        return;
    NephPhotonEvent *out = &teller->events[i];
    *out = (NephPhotonEvent){
        .kind = (NephPhotonEventKind)event->kind,
        .what = what_of(event),
        .material = material_of(teller->photons->traced->plan.scene, event),
    };
    for (int axis = 0; axis < 3; axis++) {
        out->position[axis] = event->p[axis];
        out->direction[axis] = event->direction[axis];
    }
    photons_rgb(teller->photons, event->flux, out->rgb);
}

size_t neph_photons_path(const NephPhotons *photons, size_t i, NephPhotonEvent *events,
                         size_t capacity)
{
    path_teller teller = {photons, events, 0, capacity};
    photon_class c;
    if (!photons_locate(photons, &i, &c) || !photons->traced->origins[c])
        return 0;
    render_photons_tell(photons->traced, c, photons->traced->origins[c][i].path, tell,
                        &teller);
    return teller.n;
}
