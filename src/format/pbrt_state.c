/*
 * The graphics state: what AttributeBegin keeps, AttributeEnd brings back, and the
 * directives that change nothing else.
 */
#include "format/pbrt_parser.h"

#include <string.h>

bool pbrt_attribute_begin(pbrt_parser *parser, source_place place)
{
    saved_state saved = {parser->state, place};
    g_array_append_val(parser->saved, saved);
    return true;
}

bool pbrt_attribute_end(pbrt_parser *parser, source_place place)
{
    if (parser->saved->len == 0) {
        pbrt_warning(parser, place,
                     "AttributeEnd without an AttributeBegin before it ends nothing");
        return true;
    }
    guint last = parser->saved->len - 1;
    parser->state = g_array_index(parser->saved, saved_state, last).state;
    g_array_set_size(parser->saved, last);
    return true;
}

void pbrt_close_attributes(pbrt_parser *parser, guint depth)
{
    while (parser->saved->len > depth && !pbrt_should_stop(parser)) {
        guint last = parser->saved->len - 1;
        source_place place = g_array_index(parser->saved, saved_state, last).place;
        pbrt_error(parser, place,
                   "expected AttributeEnd for this AttributeBegin, found the end of the "
                   "file");
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
    parser->object = scene_object_begin(parser->scene, name, at, &error);
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
    scene_object_end(parser->scene);
    parser->object = NO_INDEX;
    return pbrt_attribute_end(parser, place);
}

bool pbrt_object_instance(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a name", &at);
    if (!name)
        return false;
    int object = scene_find_object(parser->scene, name);
    if (object == NO_INDEX) {
        pbrt_error(parser, at, "expected the name of an object made before, found \"%s\"",
                   name);
        return true;
    }
    if (parser->object != NO_INDEX) {
        pbrt_error(parser, place, "expected ObjectEnd before ObjectInstance, found none");
        return true;
    }
    if (pbrt_is_flat(parser)) {
        pbrt_warning(parser, place, "an instance that is flattened is not seen");
        return true;
    }
    GError *error = NULL;
    motion to_world = pbrt_motion(parser);
    if (!scene_add_instance(parser->scene, object, &to_world, place, &error))
        pbrt_report(parser, error);
    return true;
}
