/*
 * Loop subdivision surfaces (Loop, "Smooth Subdivision Surfaces Based on Triangles",
 * 1987): the control mesh is refined some levels, its vertices are put on the limit
 * surface with the limit's normals, and what results is a triangle mesh.
 *
 *   old vertex of valence n   (1 - nβ) v + β Σ ring,   β = 3/16 for n = 3, else 3/(8n)
 *   new vertex on an edge     3/8 of its ends, 1/8 of the two corners across
 *   on the boundary           1/8 3/4 1/8, and 1/2 1/2
 *   limit                     β := 1 / (n + 3/(8β)), on the boundary 1/6 4/6 1/6
 *
 * The boundary is a cubic B-spline, whose limit is 1/6 4/6 1/6 at every level; pbrt has
 * 1/5 3/5 1/5, which differs by less the more levels there are.
 *
 * Rings are walked against the sense of the faces, so that normals point where pbrt's do:
 * to the side from which faces look clockwise.
 */
#include "base/memory.h"
#include "base/wanted.h"
#include "shape/mesh_params.h"
#include "shape/mesh_triangle.h"
#include "shape/shape_kinds.h"

#include <glib.h>
#include <string.h>

enum { MOST_LEVELS = 12, NO_CORNER = -1 };

/* A mesh under refinement. Corner 3 f + i is vertex i of face f; its edge goes on to the
   next corner of the face. */
typedef struct control {
    size_t n_vertices, n_faces;
    dvec3 *points;
    uint32_t *vertex; /* of a corner */
    int64_t *across;  /* the corner whose edge is the same, other way round; NO_CORNER */
    uint32_t *edge;   /* number of a corner's edge */
    size_t n_edges;
    size_t *corner; /* one of a vertex' corners; SIZE_MAX: no face has it */
} control;

static void control_clear(control *c)
{
    big_free(c->points);
    big_free(c->vertex);
    big_free(c->across);
    big_free(c->edge);
    big_free(c->corner);
    *c = (control){0};
}

static size_t next_corner(size_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static size_t previous_corner(size_t corner)
{
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/* ---- Who is beside whom ---- */

/* One end of a corner's edge. */
static uint32_t low_end(const control *c, size_t corner)
{
    return MIN(c->vertex[corner], c->vertex[next_corner(corner)]);
}

static uint32_t high_end(const control *c, size_t corner)
{
    return MAX(c->vertex[corner], c->vertex[next_corner(corner)]);
}

typedef uint32_t (*edge_end)(const control *c, size_t corner);

/* Puts corners in the order of that end, equal ones as they come.
   @param from NULL: as they are numbered @param place n_vertices + 1, for the counting */
static bool sort_corners(const control *c, edge_end end, const uint32_t *from,
                         uint32_t *to, uint32_t *place, GError **error)
{
    size_t n = 3 * c->n_faces;
    memset(place, 0, (c->n_vertices + 1) * sizeof *place);
    for (size_t i = 0; i < n && still_wanted_at(i, NULL); i++)
        place[end(c, from ? from[i] : i) + 1]++;
    for (size_t i = 0; i < c->n_vertices && still_wanted_at(i, NULL); i++)
        place[i + 1] += place[i];
    if (!still_wanted(error))
        return false;
    for (size_t i = 0; i < n && still_wanted_at(i, NULL); i++) {
        uint32_t corner = from ? from[i] : (uint32_t)i;
        to[place[end(c, corner)]++] = corner;
    }
    return still_wanted(error);
}

/* By low ends, equal ones by high ends, equal ones as they are numbered.
   @return owned (big_free); NULL: memory, or not wanted */
static uint32_t *sort_by_ends(const control *c, GError **error)
{
    size_t n = 3 * c->n_faces;
    uint32_t *place = big_alloc(c->n_vertices + 1, sizeof *place, "edges", error);
    uint32_t *by_high = place ? big_alloc(n, sizeof *by_high, "edges", error) : NULL;
    uint32_t *sorted = by_high ? big_alloc(n, sizeof *sorted, "edges", error) : NULL;
    if (sorted && !(sort_corners(c, high_end, NULL, by_high, place, error) &&
                    sort_corners(c, low_end, by_high, sorted, place, error)))
        g_clear_pointer(&sorted, big_free);
    big_free(by_high);
    big_free(place);
    return sorted;
}

static bool same_ends(const control *c, size_t a, size_t b)
{
    return low_end(c, a) == low_end(c, b) && high_end(c, a) == high_end(c, b);
}

/* Corners sorted by the ends of their edges stand beside one another; false if more than
   two do, or two that run the same way. */
static bool pair_edges(control *c, const uint32_t *sorted)
{
    size_t n = 3 * c->n_faces;
    c->n_edges = 0;
    for (size_t i = 0; i < n && still_wanted_at(i, NULL); i++) {
        size_t corner = sorted[i];
        bool again = i > 0 && same_ends(c, corner, sorted[i - 1]);
        c->across[corner] = NO_CORNER;
        if (again) {
            size_t other = sorted[i - 1];
            if (c->across[other] != NO_CORNER || c->vertex[other] == c->vertex[corner])
                return false;
            c->across[corner] = (int64_t)other;
            c->across[other] = (int64_t)corner;
        } else {
            c->n_edges++;
        }
        c->edge[corner] = (uint32_t)(c->n_edges - 1);
    }
    return true;
}

static bool pair_all(control *c, const uint32_t *sorted, source_place place,
                     GError **error)
{
    if (pair_edges(c, sorted))
        return still_wanted(error);
    error_at(error, place,
             "a subdivision surface needs edges of at most two triangles, which run "
             "through them in opposite ways");
    return false;
}

static void find_corners(control *c)
{
    memset(c->corner, 0xff, c->n_vertices * sizeof *c->corner);
    for (size_t i = 0; i < 3 * c->n_faces && still_wanted_at(i, NULL); i++)
        c->corner[c->vertex[i]] = i;
}

static bool connect(control *c, source_place place, GError **error)
{
    size_t n = 3 * c->n_faces;
    uint32_t *sorted = sort_by_ends(c, error);
    c->across = sorted ? big_alloc(n, sizeof *c->across, "edges", error) : NULL;
    c->edge = c->across ? big_alloc(n, sizeof *c->edge, "edges", error) : NULL;
    c->corner =
        c->edge ? big_alloc(c->n_vertices, sizeof *c->corner, "edges", error) : NULL;
    if (c->corner)
        find_corners(c);
    bool done = c->corner && pair_all(c, sorted, place, error);
    big_free(sorted);
    return done;
}

/* ---- The ring around a vertex ---- */

typedef struct ring {
    GArray *vertices; /* uint32_t */
    bool boundary;
} ring;

static void ring_add(ring *r, uint32_t vertex)
{
    g_array_append_val(r->vertices, vertex);
}

/* On the boundary the first and last are boundary vertices too. */
static void walk_ring(const control *c, size_t vertex, ring *r)
{
    g_array_set_size(r->vertices, 0);
    size_t start = c->corner[vertex], at = start;
    do { /* across the edge ahead, against the sense of the faces */
        ring_add(r, c->vertex[next_corner(at)]);
        if (c->across[at] == NO_CORNER)
            break;
        at = next_corner((size_t)c->across[at]);
    } while (at != start);
    r->boundary = c->across[at] == NO_CORNER;
    if (!r->boundary)
        return;
    g_array_set_size(r->vertices, 0);
    ring_add(r, c->vertex[next_corner(at)]);
    for (;;) { /* from the end of the boundary with the sense of the faces */
        size_t before = previous_corner(at);
        ring_add(r, c->vertex[before]);
        if (c->across[before] == NO_CORNER)
            return;
        at = (size_t)c->across[before];
    }
}

static dvec3 ring_point(const control *c, const ring *r, guint i)
{
    return c->points[g_array_index(r->vertices, uint32_t, i)];
}

static double beta(guint valence)
{
    return valence == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * valence);
}

/* With weight on each of the ring, or on the two boundary neighbours. */
static dvec3 weighed(const control *c, size_t vertex, const ring *r, double on_ring,
                     double on_boundary)
{
    guint n = r->vertices->len;
    if (r->boundary)
        return (1.0 - 2.0 * on_boundary) * c->points[vertex] +
               on_boundary * (ring_point(c, r, 0) + ring_point(c, r, n - 1));
    dvec3 sum = (1.0 - n * on_ring) * c->points[vertex];
    for (guint i = 0; i < n; i++)
        sum += on_ring * ring_point(c, r, i);
    return sum;
}

/* ---- One level ---- */

static void place_old(const control *c, dvec3 *to)
{
    ring r = {.vertices = g_array_new(FALSE, FALSE, sizeof(uint32_t))};
    for (size_t i = 0; i < c->n_vertices && still_wanted_at(i, NULL); i++) {
        to[i] = c->points[i];
        if (c->corner[i] == SIZE_MAX)
            continue;
        walk_ring(c, i, &r);
        to[i] = weighed(c, i, &r, beta(r.vertices->len), 1.0 / 8.0);
    }
    g_array_unref(r.vertices);
}

static dvec3 edge_point(const control *c, size_t corner)
{
    dvec3 ends = c->points[c->vertex[corner]] + c->points[c->vertex[next_corner(corner)]];
    if (c->across[corner] == NO_CORNER)
        return 0.5 * ends;
    dvec3 sides = c->points[c->vertex[previous_corner(corner)]] +
                  c->points[c->vertex[previous_corner((size_t)c->across[corner])]];
    return 3.0 / 8.0 * ends + 1.0 / 8.0 * sides;
}

static void refine_faces(const control *c, control *out)
{
    for (size_t f = 0; f < c->n_faces && still_wanted_at(f, NULL); f++) {
        uint32_t old[3], new[3];
        for (size_t i = 0; i < 3; i++) {
            old[i] = c->vertex[3 * f + i];
            new[i] = (uint32_t)c->n_vertices + c->edge[3 * f + i];
            out->points[new[i]] = edge_point(c, 3 * f + i);
        }
        const uint32_t faces[12] = {old[0], new[0], new[2], new[0], old[1], new[1],
                                    new[2], new[1], old[2], new[0], new[1], new[2]};
        memcpy(out->vertex + 12 * f, faces, sizeof faces);
    }
}

static bool refine(control *c, source_place place, GError **error)
{
    control out = {.n_vertices = c->n_vertices + c->n_edges, .n_faces = 4 * c->n_faces};
    out.points = big_alloc(out.n_vertices, sizeof *out.points, "vertices", error);
    out.vertex =
        out.points ? big_alloc(3 * out.n_faces, sizeof *out.vertex, "mesh indices", error)
                   : NULL;
    bool done = out.vertex != NULL;
    if (done) {
        place_old(c, out.points);
        refine_faces(c, &out);
        done = still_wanted(error) && connect(&out, place, error);
    }
    if (!done)
        control_clear(&out);
    control_clear(c);
    *c = out;
    return done;
}

/* ---- The limit ---- */

/* Its tangent across a boundary. */
static dvec3 tangent_inward(const control *c, size_t vertex, const ring *r)
{
    guint n = r->vertices->len;
    dvec3 p = c->points[vertex], first = ring_point(c, r, 0);
    dvec3 last = ring_point(c, r, n - 1);
    if (n == 2)
        return first + last - 2.0 * p;
    if (n == 3)
        return ring_point(c, r, 1) - p;
    double theta = G_PI / (n - 1);
    dvec3 sum = sin(theta) * (first + last);
    for (guint k = 1; k + 1 < n; k++)
        sum += (2.0 * cos(theta) - 2.0) * sin(k * theta) * ring_point(c, r, k);
    return -sum;
}

static dvec3 limit_normal(const control *c, size_t vertex, const ring *r)
{
    guint n = r->vertices->len;
    if (r->boundary)
        return dvec3_cross(ring_point(c, r, n - 1) - ring_point(c, r, 0),
                           tangent_inward(c, vertex, r));
    dvec3 s = {0}, t = {0};
    for (guint i = 0; i < n; i++) {
        double angle = 2.0 * G_PI * i / n;
        s += cos(angle) * ring_point(c, r, i);
        t += sin(angle) * ring_point(c, r, i);
    }
    return dvec3_cross(s, t);
}

static void store3(float *to, size_t i, dvec3 v)
{
    for (int k = 0; k < 3; k++)
        to[3 * i + (size_t)k] = (float)v[k];
}

static void put_on_limit(const control *c, mesh *out)
{
    ring r = {.vertices = g_array_new(FALSE, FALSE, sizeof(uint32_t))};
    for (size_t i = 0; i < c->n_vertices && still_wanted_at(i, NULL); i++) {
        store3(out->positions, i, c->points[i]);
        if (c->corner[i] == SIZE_MAX)
            continue;
        walk_ring(c, i, &r);
        guint n = r.vertices->len;
        double gamma = 1.0 / (n + 3.0 / (8.0 * beta(n)));
        dvec3 normal = limit_normal(c, i, &r);
        double length = dvec3_length(normal);
        store3(out->positions, i, weighed(c, i, &r, gamma, 1.0 / 6.0));
        store3(out->normals, i, length > 0.0 ? normal / length : normal);
    }
    g_array_unref(r.vertices);
}

static bool make_mesh(control *c, mesh *out, GError **error)
{
    out->n_vertices = c->n_vertices;
    out->n_triangles = c->n_faces;
    out->positions =
        big_alloc(3 * c->n_vertices + 1, sizeof(float), "mesh vertices", error);
    out->normals = out->positions ? big_alloc(3 * c->n_vertices + 1, sizeof(float),
                                              "mesh vertices", error)
                                  : NULL;
    if (!out->normals)
        return false;
    out->indices = c->vertex;
    put_on_limit(c, out);
    c->vertex = NULL;
    return still_wanted(error);
}

/* ---- From a scene file ---- */

static bool read_control(const params *p, control *c, int *levels, GError **error)
{
    const mesh_words words = {"subdivision surface", "triangle", 3};
    const char *scheme = "loop";
    float *points = NULL;
    bool done =
        mesh_read_points(&words, p, &c->n_vertices, &points, error) &&
        mesh_read_indices(&words, p, c->n_vertices, &c->n_faces, &c->vertex, error) &&
        params_integer(p, "levels", levels, error) &&
        params_string(p, "scheme", &scheme, error);
    if (done && strcmp(scheme, "loop") != 0) {
        error_at(error, params_find(p, "scheme")->place,
                 "the only \"scheme\" is \"loop\", found \"%s\"", scheme);
        done = false;
    }
    c->points =
        done ? big_alloc(c->n_vertices, sizeof *c->points, "vertices", error) : NULL;
    for (size_t i = 0; c->points && i < c->n_vertices && still_wanted_at(i, NULL); i++)
        c->points[i] = dvec3_from_float(
            vec3_make(points[3 * i], points[3 * i + 1], points[3 * i + 2]));
    big_free(points);
    return c->points != NULL;
}

static bool check_levels(const params *p, const control *c, int levels, GError **error)
{
    bool in_range = levels >= 0 && levels <= MOST_LEVELS;
    if (in_range && (c->n_faces << (2 * levels)) < UINT32_MAX / 3)
        return true;
    source_place place =
        params_has(p, "levels") ? params_find(p, "levels")->place : p->place;
    error_at(error, place,
             "\"levels\" of a subdivision surface must be 0..%d and leave fewer than "
             "2^32 / 3 triangles, found %d",
             MOST_LEVELS, levels);
    return false;
}

static void *create(const params *p, const shape_place *at, GError **error)
{
    control c = {0};
    mesh m = {0};
    int levels = 3;
    bool done = read_control(p, &c, &levels, error) &&
                check_levels(p, &c, levels, error) && still_wanted(error) &&
                connect(&c, p->place, error);
    for (int i = 0; i < levels && done; i++)
        done = refine(&c, p->place, error);
    done = done && make_mesh(&c, &m, error);
    control_clear(&c);
    if (done)
        return mesh_shape_create(&m, at, p->place, error);
    mesh_clear(&m);
    return NULL;
}

const shape_kind shape_subdivision = {
    .name = "loopsubdiv",
    .parameters = "P indices faceIndices levels scheme",
    .becomes = &shape_mesh,
    .may_be_flat = true,
    .create = create,
};
