/*
 * Objects and their instances:
 *
 *   shapes ── all, of the world and of objects, in the order they were added
 *   objects ── shapes with the same shape.object
 *   instances ── an object and a motion; a shape that moves is an object of its own
 */
#include "base/memory.h"
#include "scene/builder.h"

/* About what an object takes in lists. */
enum { OBJECT_SIZE = 256 };

int builder_object_begin(scene_builder *b, const char *name, source_place place,
                         GError **error)
{
    if (!builder_may_change(b, error))
        return NO_INDEX;
    if (b->open_object != NO_INDEX) {
        error_at(error, place, "an object can not hold another one, or one that moves");
        return NO_INDEX;
    }
    if (name && builder_find_object(b, name) != NO_INDEX) {
        error_at(error, place, "object \"%s\" is there already", name);
        return NO_INDEX;
    }
    if (!memory_ask(OBJECT_SIZE, "objects", error))
        return NO_INDEX;
    b->open_object = (int)b->scene->n_objects++;
    if (name)
        g_hash_table_insert(b->object_names, g_strdup(name),
                            GINT_TO_POINTER(b->open_object + 1));
    LISTENER_TELL(b, object_begin, b->open_object, name);
    return b->open_object;
}

void builder_object_end(scene_builder *b)
{
    if (b->listener && b->listener->object_end)
        b->listener->object_end(b->listener->data);
    b->open_object = NO_INDEX;
}

int builder_find_object(const scene_builder *b, const char *name)
{
    int found = GPOINTER_TO_INT(g_hash_table_lookup(b->object_names, name));
    return found ? found - 1 : NO_INDEX;
}

bool builder_expect_instances(scene_builder *b, size_t n, source_place place,
                              GError **error)
{
    size_t size;
    g_autofree char *what = g_strdup_printf("%zu instance%s", n, n == 1 ? "" : "s");
    GError *refused = NULL;
    if (__builtin_mul_overflow(n, INSTANCE_SIZE, &size))
        size = SIZE_MAX;
    if (memory_reserve(size, what, &refused)) {
        b->scene->instance_room += n;
        return true;
    }
    error_move_at(error, place, refused);
    return false;
}

bool builder_add_instance(scene_builder *b, int object, const motion *to_world,
                          source_place place, GError **error)
{
    if (!b->scene || object < 0 || (guint)object >= b->scene->n_objects) {
        error_at(error, place, "an instance needs an object, before the scene is whole");
        return false;
    }
    if (b->scene->instances->len == b->scene->instance_room &&
        !builder_expect_instances(b, 1, place, error))
        return false;
    b->scene->is_animated |= to_world->moves;
    instance made = {object, *to_world, place};
    LISTENER_TELL(b, instance, object, to_world);
    g_array_append_val(b->scene->instances, made);
    return true;
}
