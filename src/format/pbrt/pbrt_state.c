/*
 * The graphics state: what AttributeBegin keeps, AttributeEnd brings back, and the
 * directives that change nothing else.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/intern.h"

#include <string.h>

bool pbrt_attribute_begin(pbrt_parser *parser, source_place place)
{
    saved_state saved = {parser->state, place};
    if (parser->saved->len >= MAX_ATTRIBUTES) {
        pbrt_error(parser, place, "expected at most %d AttributeBegin within each other",
                   MAX_ATTRIBUTES);
        return true;
    }
    g_array_append_val(parser->saved, saved);
    return true;
}

static void take_back(pbrt_parser *parser, source_place place)
{
    if (parser->saved->len == 0) {
        pbrt_warning(parser, place,
                     "AttributeEnd without an AttributeBegin before it ends nothing");
        return;
    }
    guint last = parser->saved->len - 1;
    parser->state = g_array_index(parser->saved, saved_state, last).state;
    g_array_set_size(parser->saved, last);
}

bool pbrt_attribute_end(pbrt_parser *parser, source_place place)
{
    v3_name *given = parser->state.v3_names;
    take_back(parser, place);
    pbrt_v3_end_names(given, parser->state.v3_names);
    return true;
}

bool pbrt_transform_end(pbrt_parser *parser, source_place place)
{
    graphics_state kept = parser->state;
    if (!parser->is_v3)
        return pbrt_attribute_end(parser, place);
    take_back(parser, place);
    kept.ctm = parser->state.ctm;
    kept.ctm_end = parser->state.ctm_end;
    kept.active = parser->state.active;
    parser->state = kept;
    return true;
}

void pbrt_close_attributes(pbrt_parser *parser, guint depth)
{
    while (parser->saved->len > depth && !pbrt_should_stop(parser)) {
        guint last = parser->saved->len - 1;
        source_place place = g_array_index(parser->saved, saved_state, last).place;
        if (parser->is_v3)
            pbrt_warning(parser, place, "this AttributeBegin has no AttributeEnd");
        else
            pbrt_error(parser, place,
                       "expected AttributeEnd for this AttributeBegin, found the end of "
                       "the file");
        pbrt_attribute_end(parser, place);
    }
}

bool pbrt_attribute(pbrt_parser *parser, source_place place)
{
    static const char *const names[N_TARGETS] = {"shape", "light", "material", "medium",
                                                 "texture"};
    source_place at = place;
    g_autofree char *target = pbrt_read_string(parser, "a kind of directive", &at);
    params *given = target ? pbrt_read_params(parser, place) : NULL;
    if (!given)
        return false;
    g_ptr_array_add(parser->kept, given);
    for (int i = 0; i < N_TARGETS; i++)
        if (strcmp(target, names[i]) == 0) {
            attribute *a = g_new(attribute, 1);
            *a = (attribute){given, parser->state.attributes[i]};
            g_ptr_array_add(parser->attributes, a);
            parser->state.attributes[i] = a;
            return true;
        }
    pbrt_error(parser, at,
               "expected \"shape\", \"light\", \"material\", \"medium\" or \"texture\", "
               "found \"%s\"",
               target);
    return true;
}

bool pbrt_reverse_orientation(pbrt_parser *parser, source_place place)
{
    (void)place;
    parser->state.reverse_orientation = !parser->state.reverse_orientation;
    return true;
}

bool pbrt_color_space(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a colour space", &at);
    if (!name)
        return false;
    const color_space *space = color_space_find(name);
    if (space)
        parser->state.space = space;
    else
        pbrt_warning(parser, at,
                     "there is no colour space \"%s\", but \"srgb\", \"rec2020\", "
                     "\"dci-p3\" and \"aces2065-1\"; the one before stays",
                     name);
    return true;
}

/** In pbrt-v3 an object may be given again. */
static char *new_object_name(pbrt_parser *parser, const char *name, source_place at)
{
    char *own = g_strdup(name);
    guint n = parser->builder->scene->n_objects;
    for (guint i = n + 1; builder_find_object(parser->builder, own) != NO_INDEX; i++) {
        g_free(own);
        own = g_strdup_printf("%s, %u", name, i);
    }
    if (strcmp(own, name) != 0)
        log_at(&parser->builder->build.log, LOG_NOTE, at,
               "pbrt-v3: \"%s\" is given again; what follows has the new one", name);
    g_hash_table_insert(parser->v3_objects, g_strdup(name), (char *)intern(own));
    return own;
}

/** Opens attributes too, as ObjectEnd closes them. */
bool pbrt_object_begin(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a name", &at);
    if (!name)
        return false;
    GError *error = NULL;
    if (parser->object != NO_INDEX) {
        pbrt_error(parser, place, "expected ObjectEnd before another ObjectBegin");
        return true;
    }
    pbrt_attribute_begin(parser, place);
    g_autofree char *own = parser->is_v3 ? new_object_name(parser, name, at) : NULL;
    parser->object = builder_object_begin(parser->builder, own ? own : name, at, &error);
    parser->object_place = place;
    if (parser->object == NO_INDEX) {
        pbrt_report(parser, error);
        pbrt_attribute_end(parser, place);
    }
    return true;
}

bool pbrt_object_end(pbrt_parser *parser, source_place place)
{
    if (parser->object == NO_INDEX) {
        pbrt_error(parser, place, "expected ObjectBegin before ObjectEnd, found none");
        return true;
    }
    builder_object_end(parser->builder);
    parser->object = NO_INDEX;
    return pbrt_attribute_end(parser, place);
}

static void make_instance(pbrt_parser *parser, const char *name,
                          const directive_arguments *a)
{
    const char *own = g_hash_table_lookup(parser->v3_objects, name);
    int object = builder_find_object(parser->builder, own ? own : name);
    GError *error = NULL;
    motion to_world = pbrt_motion(parser);
    if (object == NO_INDEX && parser->is_v3)
        pbrt_warning(parser, a->at, "there is no object \"%s\" to be seen here", name);
    else if (object == NO_INDEX)
        pbrt_error(parser, a->at, "expected the name of an object, found \"%s\"", name);
    else if (pbrt_is_flat(parser))
        pbrt_warning(parser, a->at, "an instance that is flattened is not seen");
    else if (!builder_add_instance(parser->builder, object, &to_world, a->at, &error))
        pbrt_report(parser, error);
}

bool pbrt_object_instance(pbrt_parser *parser, source_place place)
{
    directive_arguments a = {.at = place};
    g_autofree char *name = pbrt_read_string(parser, "a name", &a.at);
    if (!name)
        return false;
    if (parser->object != NO_INDEX && parser->is_v3)
        pbrt_warning(parser, place, "an instance within an object is left out");
    else if (parser->object != NO_INDEX)
        pbrt_error(parser, place, "expected ObjectEnd before ObjectInstance, found none");
    else if (builder_find_object(parser->builder, name) == NO_INDEX && !parser->is_v3)
        pbrt_wait(parser, LATE_INSTANCE, make_instance, name, &a);
    else
        make_instance(parser, name, &a);
    return true;
}
