/*
 * Normal maps hold n = 2 rgb - 1 in the frame (dpdu, dpdv, n): red along u, green along
 * v, which is up in the image. Where the texture is mirrored green follows it, as it
 * does in the tools that bake such maps (MikkTSpace).
 *
 * A displacement d bends the tangents, ∂p'/∂u = ∂p/∂u + ∂d/∂u n, and likewise for v; the
 * term d ∂n/∂u is left out, as it is small for displacements that are. Differences are
 * taken over pbrt-v4's step, and at the same points for photons and the eye.
 */
#include "material/material_bump.h"

#include "texture/picture.h"
#include "texture/texture.h"

#include <glib.h>

#define STEP 0.0005f

struct bump {
    picture *normals;       /* NULL: it is something else */
    const texture *texture; /* borrowed: a map that is a texture; NULL */
    float scale;            /* of the map's x and y */
    float_input displacement;
};

static bool read_texture(bump *b, const build_context *context, const param *q,
                         GError **error)
{
    b->texture = texture_find(context, q, true, error);
    if (!b->texture || texture_is_normal_map(b->texture))
        return b->texture != NULL;
    error_at(error, q->place,
             "parameter 'normalmap': a texture of kind '%s' can not be a normal map",
             texture_kind_name(b->texture));
    return false;
}

static bool read_normals(bump *b, const build_context *context, const params *p,
                         GError **error)
{
    const image_read_options linear = {.encoding = ENCODING_LINEAR};
    const param *q = params_find(p, "normalmap");
    b->scale = 1.0f;
    if (!params_float(p, "normalscale", &b->scale, error))
        return false;
    if (q->type == PARAM_TEXTURE)
        return read_texture(b, context, q, error);
    b->normals = picture_read(context, p, "normalmap", &linear, error);
    return b->normals != NULL;
}

bool bump_new(bump **out, const build_context *context, const params *p, GError **error)
{
    bool mapped = params_has(p, "normalmap"), displaced = params_has(p, "displacement");
    *out = NULL;
    if (mapped && displaced) {
        error_at(error, params_find(p, "displacement")->place,
                 "a material has either 'normalmap' or 'displacement'");
        return false;
    }
    if (!mapped && !displaced)
        return true;
    bump *b = g_new0(bump, 1);
    if (mapped ? read_normals(b, context, p, error)
               : float_input_init(&b->displacement, context, p, "displacement", 0.0f,
                                  error)) {
        *out = b;
        return true;
    }
    bump_free(b);
    return false;
}

void bump_free(bump *b)
{
    if (!b)
        return;
    picture_unref(b->normals);
    g_free(b);
}

static void look_up(const bump *b, const surface_hit *hit, float rgb[3])
{
    vec2 st = {hit->uv.x, 1.0f - hit->uv.y};
    texel_mix mix = picture_bilinear(b->normals, 0, st, WRAP_REPEAT);
    picture_rgb(b->normals, &mix, rgb);
}

static vec3 mapped_normal(const bump *b, const surface_hit *hit)
{
    vec3 dpdu = hit->dpdu, dpdv = hit->dpdv;
    float rgb[3];
    if (b->texture)
        texture_eval_normal(b->texture, hit, rgb, &dpdu, &dpdv);
    else
        look_up(b, hit, rgb);
    frame f = frame_from_tangent(hit->n, dpdu);
    float mirrored = dot3(f.t, dpdv) < 0.0f ? -1.0f : 1.0f;
    vec3 local =
        vec3_make(b->scale * (2.0f * rgb[0] - 1.0f),
                  b->scale * mirrored * (2.0f * rgb[1] - 1.0f), 2.0f * rgb[2] - 1.0f);
    return frame_to_world(&f, local);
}

/* The displacement at a step along one tangent. */
static float displaced(const bump *b, const surface_hit *hit, float du, float dv,
                       vec3 along)
{
    surface_hit moved = *hit;
    moved.p += (du + dv) * along;
    moved.uv.x += du;
    moved.uv.y += dv;
    return float_input_eval(&b->displacement, &moved);
}

static vec3 displaced_normal(const bump *b, const surface_hit *hit)
{
    vec3 dpdu = hit->dpdu, dpdv = hit->dpdv;
    if (!(length3_2(dpdv) > 0.0f))
        dpdv = cross3(hit->n, dpdu);
    float here = float_input_eval(&b->displacement, hit);
    float slope_u = (displaced(b, hit, STEP, 0.0f, dpdu) - here) / STEP;
    float slope_v = (displaced(b, hit, 0.0f, STEP, dpdv) - here) / STEP;
    dpdu -= hit->n * dot3(hit->n, dpdu);
    dpdv -= hit->n * dot3(hit->n, dpdv);
    vec3 bent = cross3(dpdu + slope_u * hit->n, dpdv + slope_v * hit->n);
    return face_forward(bent, hit->n);
}

frame bump_frame(const bump *b, const surface_hit *hit)
{
    vec3 n = normalize3(b->normals || b->texture ? mapped_normal(b, hit)
                                                 : displaced_normal(b, hit));
    if (!(length3_2(n) > 0.5f) || !finite3(n))
        n = hit->n;
    return frame_from_tangent(n, hit->dpdu);
}
