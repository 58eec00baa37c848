/*
 * Names that a file gives after it used them. pbrt-v4 asks what they mean once it has
 * read everything, so a material may be named before it is made, a texture before there
 * is one, an object before it begins.
 *
 * What can not be made yet waits here with the graphics state it stood in, and is made at
 * the end: textures before materials, these before shapes, as their names become known.
 * A shape does not wait for its material, whose place in the scene is kept free.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/intern.h"

#include <string.h>

typedef struct late_directive {
    late_maker make;
    late_rank rank;
    char *name;
    directive_arguments a;
    graphics_state state;
} late_directive;

static void clear_late(void *data)
{
    late_directive *l = data;
    g_free(l->name);
    pbrt_clear_arguments(&l->a);
    g_free(l);
}

GPtrArray *pbrt_late_new(void)
{
    return g_ptr_array_new_with_free_func(clear_late);
}

static bool is_there(const pbrt_parser *parser, const param *q, const char *name)
{
    const build_context *known = &parser->builder->build;
    if (q->type == PARAM_TEXTURE)
        return g_hash_table_contains(known->float_textures, name) ||
               g_hash_table_contains(known->spectrum_textures, name);
    if (q->type == PARAM_STRING && strcmp(q->name, "materials") == 0)
        return g_hash_table_contains(known->materials, name) ||
               g_hash_table_contains(parser->interfaces, name);
    return true;
}

static bool has_names(const pbrt_parser *parser, const params *p)
{
    for (guint i = 0; i < p->list->len; i++) {
        const param *q = p->list->pdata[i];
        for (size_t k = 0; q->strings && k < q->n; k++)
            if (!is_there(parser, q, q->strings[k]))
                return false;
    }
    return true;
}

bool pbrt_must_wait(const pbrt_parser *parser, const params *p)
{
    return !parser->is_v3 && !parser->at_end && !has_names(parser, p);
}

void pbrt_wait(pbrt_parser *parser, late_rank rank, late_maker make, const char *name,
               directive_arguments *a)
{
    late_directive *l = g_new0(late_directive, 1);
    *l = (late_directive){.make = make,
                          .rank = rank,
                          .name = g_strdup(name),
                          .a = *a,
                          .state = parser->state};
    *a = (directive_arguments){0};
    g_ptr_array_add(parser->late, l);
}

/* Makes what waits in a rank and has its names now, or (last) all that is left. */
static bool make_some(pbrt_parser *parser, late_rank rank, bool last)
{
    bool any = false;
    for (guint i = 0; i < parser->late->len && !pbrt_should_stop(parser); i++) {
        late_directive *l = parser->late->pdata[i];
        if (!l->make || l->rank != rank ||
            (!last && l->a.p && !has_names(parser, l->a.p)))
            continue;
        parser->state = l->state;
        l->make(parser, l->name, &l->a);
        l->make = NULL;
        any = true;
    }
    return any;
}

void pbrt_make_late(pbrt_parser *parser)
{
    graphics_state state = parser->state;
    parser->at_end = true;
    for (int rank = 0; rank < N_LATE_RANKS; rank++) {
        while (make_some(parser, (late_rank)rank, false))
            ;
        make_some(parser, (late_rank)rank, true);
    }
    parser->state = state;
}

/* ---- Materials that are named before they are made ---- */

int pbrt_await_material(pbrt_parser *parser, const char *name, source_place place)
{
    medium_name awaited = {intern(name), place};
    g_array_append_val(parser->awaited_materials, awaited);
    return builder_await_material(parser->builder, name);
}

void pbrt_check_materials(pbrt_parser *parser)
{
    for (guint i = 0; i < parser->awaited_materials->len && !pbrt_should_stop(parser);
         i++) {
        const medium_name *m = &g_array_index(parser->awaited_materials, medium_name, i);
        if (builder_material_is_awaited(parser->builder, m->name))
            pbrt_error(parser, m->place, "expected the name of a material, found \"%s\"",
                       m->name);
    }
}
