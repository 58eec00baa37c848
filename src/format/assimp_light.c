/*
 * assimp's lights and cameras. Their places are those of the node of their name; few
 * formats say in what units lamps shine, so colours are taken as W/sr, or W/m² of
 * directional light.
 */
#include "format/assimp.h"

#include "format/given.h"

#include <math.h>

#define DEGREES (180.0 / G_PI)

static vec3 vector_of(struct aiVector3D v)
{
    return vec3_make(v.x, v.y, v.z);
}

static bool give_light_color(params *p, const char *name, const struct aiLight *l)
{
    const struct aiColor3D *c = &l->mColorDiffuse;
    if (!isfinite(c->r + c->g + c->b) || !(c->r + c->g + c->b > 0.0f))
        return false;
    give_triple(p, PARAM_RGB, name, fmax(0.0, (double)c->r), fmax(0.0, (double)c->g),
                fmax(0.0, (double)c->b));
    return true;
}

static void give_point(params *p, const char *name, vec3 v)
{
    give_triple(p, PARAM_POINT3, name, (double)v[0], (double)v[1], (double)v[2]);
}

static bool add_light(assimp_reader *r, const struct aiLight *l, GError **error)
{
    const transform to_world = assimp_node_to_world(r, l->mName.data);
    vec3 from = vector_of(l->mPosition), to = from + vector_of(l->mDirection);
    g_autoptr(params) p = assimp_params(r);
    bool directed = length3(to - from) > 0.0f && finite3(to);
    bool distant = l->mType == aiLightSource_DIRECTIONAL;
    const char *kind = distant ? "distant" : "point";
    if (!give_light_color(p, distant ? "L" : "I", l) || !finite3(from) ||
        (distant && !directed))
        return true;
    if (l->mType == aiLightSource_SPOT && directed) {
        double outer = CLAMP((double)l->mAngleOuterCone * 0.5 * DEGREES, 1.0, 89.9);
        double inner = CLAMP((double)l->mAngleInnerCone * 0.5 * DEGREES, 0.0, outer);
        kind = "spot";
        give_float(p, "coneangle", outer);
        give_float(p, "conedeltaangle", outer - inner);
    } else if (!distant && l->mType != aiLightSource_POINT) {
        assimp_note(r, "a light that is neither point, spot nor directional is left out");
        return true;
    }
    give_point(p, "from", from);
    if (kind[0] != 'p')
        give_point(p, "to", to);
    assimp_note(r, "lamps are taken to shine in W/sr and W/m²");
    return scene_add_light(r->scene, kind, p, &to_world, error);
}

bool assimp_add_lights(assimp_reader *r, GError **error)
{
    for (unsigned i = 0; i < r->source->mNumLights; i++)
        if (!add_light(r, r->source->mLights[i], error))
            return false;
    return true;
}

static bool camera_place(const transform *node, const struct aiCamera *c, transform *out)
{
    vec3 eye = transform_point(node, vector_of(c->mPosition));
    vec3 z = normalize3(transform_vector(node, vector_of(c->mLookAt)));
    vec3 x = normalize3(cross3(z, transform_vector(node, vector_of(c->mUp))));
    vec3 y = cross3(x, z);
    double m[4][4] = {{0}};
    for (int i = 0; i < 3; i++) {
        m[i][0] = (double)x[i];
        m[i][1] = (double)y[i];
        m[i][2] = (double)z[i];
        m[i][3] = (double)eye[i];
    }
    m[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])m, out);
}

bool assimp_add_camera(assimp_reader *r, GError **error)
{
    enum { HEIGHT = 720 };
    if (r->source->mNumCameras == 0)
        return true;
    const struct aiCamera *c = r->source->mCameras[0];
    const transform node = assimp_node_to_world(r, c->mName.data);
    transform place;
    double aspect = c->mAspect > 0.0f ? CLAMP((double)c->mAspect, 0.1, 10.0) : 4.0 / 3.0;
    double wide = tan(0.5 * CLAMP((double)c->mHorizontalFOV, 0.01, 3.0));
    if (!camera_place(&node, c, &place)) {
        assimp_note(r, "a camera that looks nowhere is left out");
        return true;
    }
    g_autoptr(params) film = assimp_params(r), p = assimp_params(r);
    give_integer(film, "yresolution", HEIGHT);
    give_integer(film, "xresolution", (int)lround(HEIGHT * aspect));
    give_float(p, "fov", 2.0 * atan(aspect > 1.0 ? wide / aspect : wide) * DEGREES);
    return scene_set_film(r->scene, "rgb", film, error) &&
           scene_set_camera(r->scene, "perspective", p, &place, error);
}
