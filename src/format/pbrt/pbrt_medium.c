/*
 * Participating media. MediumInterface names two that are then around; which they are is
 * asked when a shape, a light or the camera is given to the scene, so that a medium may
 * be made between being named and being used.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/intern.h"
#include "format/lenient.h"

#include <string.h>

/* Of one that was made, even if it turned out to be none. */
static bool is_made(const pbrt_parser *parser, const char *name)
{
    return builder_find_medium(parser->builder, name) != NO_INDEX ||
           g_hash_table_contains(parser->empty_media, name);
}

/** One name for both sides, or two; empty is vacuum. */
bool pbrt_medium_interface(pbrt_parser *parser, source_place place)
{
    medium_name both[2] = {{.place = place}, {.place = place}};
    int n = 0;
    do {
        g_autofree char *name = pbrt_read_string(parser, "a medium", &both[n].place);
        if (!name)
            return false;
        both[n].name = *name ? intern(name) : NULL;
        if (*name && !is_made(parser, name))
            g_array_append_val(parser->awaited_media, both[n]);
    } while (++n < 2 && lexer_peek(parser->words).kind == TOKEN_STRING);
    parser->state.inside = both[0];
    parser->state.outside = both[n - 1];
    return true;
}

static bool add_medium(pbrt_parser *parser, const char *name, const char *type, params *p)
{
    GError *error = NULL;
    g_autofree char *kind = g_strdup(type);
    if (parser->is_v3 && !pbrt_v3_knows(parser, V3_MEDIUM, type, p->place))
        return false;
    if (parser->is_v3)
        pbrt_v3_translate(V3_MEDIUM, &kind, p, &parser->builder->build.log, NULL);
    bool is_empty = lenient_medium(&parser->builder->build, name, kind, p, &error);
    int index = is_empty || error
                    ? NO_INDEX
                    : builder_add_medium(parser->builder, name, kind, p, &error);
    if (error)
        pbrt_report(parser, error);
    return index != NO_INDEX;
}

/* In pbrt-v3 a medium may be given again: what comes later is in the new one. */
static const char *new_name(pbrt_parser *parser, const char *name, source_place at)
{
    if (!is_made(parser, name))
        return name;
    g_autofree char *own =
        g_strdup_printf("%s, %u", name, parser->builder->scene->media->len + 1);
    log_at(&parser->builder->build.log, LOG_NOTE, at,
           "pbrt-v3: \"%s\" is given again; what follows has the new one", name);
    const char *kept = intern(own);
    g_hash_table_insert(parser->v3_media, (char *)intern(name), (char *)kept);
    return kept;
}

static void make_named_medium(pbrt_parser *parser, const char *name, source_place at,
                              params *p)
{
    GError *error = NULL;
    const char *kind = NULL;
    if (!params_string(p, "type", &kind, &error))
        pbrt_report(parser, error);
    else if (!*name)
        pbrt_error(parser, at, "expected a medium's name, found \"\", which is none");
    else if (!kind)
        pbrt_error(parser, at, "expected \"string type\" of medium '%s', found none",
                   name);
    else if (is_made(parser, name) && !parser->is_v3)
        pbrt_error(parser, at, "expected a new medium's name, found \"%s\" again", name);
    else if (add_medium(parser, new_name(parser, name, at), kind, p))
        return;
    g_hash_table_add(parser->empty_media, g_strdup(name));
}

bool pbrt_make_named_medium(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a name", &at);
    g_autoptr(params) p =
        name ? pbrt_read_params_for(parser, place, TARGET_MEDIUM) : NULL;
    if (!p)
        return false;
    make_named_medium(parser, name, at, p);
    return true;
}

/* Index of a medium, or NO_INDEX. One that is not made is told of once. */
static int find_medium(pbrt_parser *parser, const medium_name *m)
{
    if (!m->name)
        return NO_INDEX;
    const char *own = g_hash_table_lookup(parser->v3_media, m->name);
    bool is_new = !is_made(parser, m->name) &&
                  g_hash_table_add(parser->missing_media, (char *)m->name);
    if (is_new && parser->is_v3)
        pbrt_warning(parser, m->place, "there is no medium \"%s\"", m->name);
    else if (is_new)
        pbrt_error(parser, m->place,
                   "expected the name of a medium made before it is used, found \"%s\"",
                   m->name);
    return builder_find_medium(parser->builder, own ? own : m->name);
}

bool pbrt_awaits_media(const pbrt_parser *parser)
{
    const char *in = parser->state.inside.name, *out = parser->state.outside.name;
    return !parser->is_v3 && !parser->at_end &&
           ((in && !is_made(parser, in)) || (out && !is_made(parser, out)));
}

void pbrt_use_media(pbrt_parser *parser, const medium_name *inside,
                    const medium_name *outside)
{
    int in = find_medium(parser, inside), out = find_medium(parser, outside);
    builder_set_medium_interface(parser->builder, in, out);
}

void pbrt_check_media(pbrt_parser *parser)
{
    for (guint i = 0; i < parser->awaited_media->len && !pbrt_should_stop(parser); i++)
        find_medium(parser, &g_array_index(parser->awaited_media, medium_name, i));
}
