/*
 * What a mesh's vertices say beyond one set of texture coordinates: a second set, and
 * colours. A hit only keeps which mesh it is on and where in the triangle, so that what
 * no texture asks for costs nothing.
 */
#pragma once

#include "medium/hit.h"

/** @brief The three vertices of the hit's triangle. Only of hits on meshes. */
static inline const uint32_t *hit_vertices(const surface_hit *hit)
{
    return hit->mesh->indices + 3 * (size_t)hit->primitive;
}

/** @brief The second texture coordinates, or the first where there are none. */
static inline vec2 hit_second_uv(const surface_hit *hit)
{
    if (!hit->mesh || !hit->mesh->uvs2)
        return hit->uv;
    const uint32_t *v = hit_vertices(hit);
    const vec2 *uv = hit->mesh->uvs2;
    float b1 = hit->corners.x, b2 = hit->corners.y, b0 = 1.0f - b1 - b2;
    return (vec2){b0 * uv[v[0]].x + b1 * uv[v[1]].x + b2 * uv[v[2]].x,
                  b0 * uv[v[0]].y + b1 * uv[v[1]].y + b2 * uv[v[2]].y};
}

/** @brief Component 0..3 (linear red, green, blue, opacity) of the vertices' colour; 1
 * where there is none. */
static inline float hit_vertex_color(const surface_hit *hit, int component)
{
    if (!hit->mesh || !hit->mesh->colors)
        return 1.0f;
    const uint32_t *v = hit_vertices(hit);
    const float *color = hit->mesh->colors + component;
    float b1 = hit->corners.x, b2 = hit->corners.y;
    return (1.0f - b1 - b2) * color[4 * (size_t)v[0]] + b1 * color[4 * (size_t)v[1]] +
           b2 * color[4 * (size_t)v[2]];
}

/** @brief Turns tangents of the first coordinates into those of the second; leaves them
 * where either set does not tell. */
static inline void hit_second_tangents(const surface_hit *hit, vec3 *dpdu, vec3 *dpdv)
{
    const mesh *m = hit->mesh;
    if (!m || !m->uvs2 || !m->uvs)
        return;
    const uint32_t *v = hit_vertices(hit);
    const vec2 *a = m->uvs, *b = m->uvs2;
    float u1 = b[v[1]].x - b[v[0]].x, v1 = b[v[1]].y - b[v[0]].y;
    float u2 = b[v[2]].x - b[v[0]].x, v2 = b[v[2]].y - b[v[0]].y;
    float determinant = u1 * v2 - u2 * v1;
    vec3 e1 = *dpdu * (a[v[1]].x - a[v[0]].x) + *dpdv * (a[v[1]].y - a[v[0]].y);
    vec3 e2 = *dpdu * (a[v[2]].x - a[v[0]].x) + *dpdv * (a[v[2]].y - a[v[0]].y);
    vec3 along_u = (e1 * v2 - e2 * v1) / determinant;
    vec3 along_v = (e2 * u1 - e1 * u2) / determinant;
    if (!finite3(along_u) || !finite3(along_v))
        return;
    *dpdu = along_u;
    *dpdv = along_v;
}
