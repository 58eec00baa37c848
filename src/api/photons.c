/*
 * Photons on their way out: counted through over the stores, directions unpacked,
 * and the flux at the pass' eight wavelengths turned into linear sRGB.
 */
#include "api/photons.h"

#include "api/asking.h"
#include "api/statistics.h"
#include "base/output.h"

NephPhotons *neph_photons_trace_while(const NephScene *s, const NephSettings *how,
                                      NephGoOnFunc go_on, void *data, GError **error)
{
    asking a;
    const cancel_flag *cancel = asking_begin(&a, go_on, data);
    render_photons *traced = render_trace_photons(s->view, &how->values, cancel, error);
    if (!traced)
        return NULL;
    NephPhotons *photons = g_new(NephPhotons, 1);
    photons->traced = traced;
    return photons;
}

NephPhotons *neph_photons_trace(const NephScene *s, const NephSettings *how,
                                GError **error)
{
    return neph_photons_trace_while(s, how, NULL, NULL, error);
}

bool neph_photons_follow(NephPhotons *photons, NephGoOnFunc go_on, void *data,
                         GError **error)
{
    asking a;
    const cancel_flag *cancel = asking_begin(&a, go_on, data);
    return render_photons_follow(photons->traced, cancel, error);
}

void neph_photons_free(NephPhotons *photons)
{
    if (!photons)
        return;
    render_photons_free(photons->traced);
    g_free(photons);
}

size_t neph_photons_count(const NephPhotons *photons)
{
    size_t n = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        n += render_photons_count(photons->traced, (photon_class)c);
    return n;
}

bool photons_locate(const NephPhotons *photons, size_t *i, photon_class *c)
{
    const render_photons *traced = photons->traced;
    for (*c = 0; *c < N_PHOTON_CLASSES; (*c)++) {
        size_t n = render_photons_count(traced, *c);
        if (*i < n)
            return true;
        *i -= n;
    }
    return false;
}

void photons_rgb(const NephPhotons *photons, spectrum flux, float rgb[3])
{
    float xyz[3];
    spectrum_to_xyz(&photons->traced->w, flux, xyz);
    color_space_from_xyz(color_space_srgb(), xyz, rgb);
}

/* What a stored direction may be off by (photon/photon.h), and rounding. */
#define STORED_ERROR 1.1e-4f

/* In full where the path is known, but on what has been turned to the middle of a slice
   of time as it is stored. */
static vec3 direction_of(const photon *stored, const photon_origin *origin)
{
    if (!origin)
        return stored->wi;
    vec3 full = vec3_make(origin->wi[0], origin->wi[1], origin->wi[2]);
    return length3(full - stored->wi) <= STORED_ERROR ? full : stored->wi;
}

bool neph_photons_get(const NephPhotons *photons, size_t i, NephPhoton *out)
{
    const render_photons *traced = photons->traced;
    photon_class c;
    *out = (NephPhoton){0};
    if (!photons_locate(photons, &i, &c))
        return false;
    const photon found = render_photons_get(traced, c, i);
    const photon_origin *origin = traced->origins[c] ? &traced->origins[c][i] : NULL;
    const vec3 wi = direction_of(&found, origin);
    photons_rgb(photons, found.flux, out->rgb);
    for (int axis = 0; axis < 3; axis++) {
        out->position[axis] = found.p[axis];
        out->direction[axis] = wi[axis];
    }
    out->photon_class = (NephPhotonClass)c;
    out->bounces = origin ? origin->bounces : 0;
    return true;
}

const char *neph_photons_medium(const NephPhotons *photons, size_t i)
{
    const render_photons *traced = photons->traced;
    photon_class c;
    if (!photons_locate(photons, &i, &c) || i < traced->stores[c].n)
        return "";
    size_t n = traced->stores[c].n;
    return scene_medium(traced->plan.scene, traced->in_media[c].home[i - n])->name;
}

void neph_photons_statistics(const NephPhotons *photons, NephStatistics *out)
{
    *out = statistics_export(&photons->traced->statistics);
}

static void write_header(FILE *file, size_t n)
{
    fprintf(file,
            "ply\n"
            "format binary_%s_endian 1.0\n"
            "comment photons by Nephroid %s\n"
            "comment nx ny nz: to where the photon came from; class: 0 direct, "
            "1 indirect, 2 caustic\n"
            "element vertex %zu\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property float red\nproperty float green\nproperty float blue\n"
            "property uchar class\n"
            "end_header\n",
            G_BYTE_ORDER == G_LITTLE_ENDIAN ? "little" : "big", neph_version(), n);
}

static void write_photon(FILE *file, const NephPhoton *p)
{
    const unsigned char which = (unsigned char)p->photon_class;
    fwrite(p->position, sizeof *p->position, 3, file);
    fwrite(p->direction, sizeof *p->direction, 3, file);
    fwrite(p->rgb, sizeof *p->rgb, 3, file);
    fwrite(&which, 1, 1, file);
}

bool neph_photons_write_ply(const NephPhotons *photons, const char *path, GError **error)
{
    output *out = output_open(path, error);
    if (!out)
        return false;
    const size_t n = neph_photons_count(photons);
    write_header(output_stream(out), n);
    for (size_t i = 0; i < n; i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        write_photon(output_stream(out), &p);
    }
    return output_commit(out, error);
}

bool neph_photons_event_log(const NephScene *s, const NephSettings *how, size_t n,
                            void (*write)(const char *line, void *data), void *data,
                            GError **error)
{
    return render_photon_event_log(s->view, &how->values, n, write, data, error);
}
