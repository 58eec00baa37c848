#include "format/gltf/gltf_animation.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

typedef enum interpolation { STEP, LINEAR, CUBIC } interpolation;

/* A sampler: keys of so many numbers each. */
typedef struct track {
    float *times, *values; /* big_alloc'ed */
    size_t n;              /* keys */
    size_t width;          /* numbers of a value */
    interpolation how;
} track;

/* Between which keys a time lies. */
typedef struct moment {
    size_t from, to;
    double step; /* s, from one to the other */
    double u;    /* 0..1 */
} moment;

static moment moment_at(const track *t, double time)
{
    size_t to = 0;
    while (to < t->n && (double)t->times[to] <= time)
        to++;
    if (to == 0 || to == t->n)
        return (moment){.from = to == 0 ? 0 : t->n - 1, .to = to == 0 ? 0 : t->n - 1};
    double begin = (double)t->times[to - 1], step = (double)t->times[to] - begin;
    return (moment){to - 1, to, step, (time - begin) / step};
}

/* Number i of a key's value; of a spline's key the tangents stand around it. */
static double value_of(const track *t, size_t key, size_t i)
{
    size_t at = t->how == CUBIC ? 3 * key + 1 : key;
    return (double)t->values[at * t->width + i];
}

/* Hermite's spline. */
static double cubic(const track *t, const moment *m, size_t i)
{
    double u = m->u, u2 = u * u, u3 = u2 * u;
    double out = (double)t->values[(3 * m->from + 2) * t->width + i];
    double in = (double)t->values[3 * m->to * t->width + i];
    return (2 * u3 - 3 * u2 + 1) * value_of(t, m->from, i) +
           m->step * (u3 - 2 * u2 + u) * out + (3 * u2 - 2 * u3) * value_of(t, m->to, i) +
           m->step * (u3 - u2) * in;
}

static double sample(const track *t, const moment *m, size_t i)
{
    if (t->how == CUBIC && m->to != m->from)
        return cubic(t, m, i);
    double u = t->how == STEP ? 0.0 : m->u;
    return (1.0 - u) * value_of(t, m->from, i) + u * value_of(t, m->to, i);
}

/* Quaternions turn evenly, by the shorter way. */
static void sample_turn(const track *t, const moment *m, double out[4])
{
    double dot = 0.0, a[4], b[4];
    for (size_t i = 0; i < 4; i++) {
        a[i] = value_of(t, m->from, i);
        b[i] = value_of(t, m->to, i);
        dot += a[i] * b[i];
    }
    double angle = acos(fmin(fabs(dot), 1.0)), sine = sin(angle);
    double u = m->u, of_a = 1.0 - u, of_b = dot < 0.0 ? -u : u;
    if (sine > 1e-6) {
        of_a = sin((1.0 - u) * angle) / sine;
        of_b = copysign(sin(u * angle) / sine, of_b);
    }
    for (size_t i = 0; i < 4; i++)
        out[i] = of_a * a[i] + of_b * b[i];
}

/* ---- Reading ---- */

static bool read_how(const json_value *sampler, track *t)
{
    const char *word = json_text(sampler, "interpolation");
    t->how = !word || strcmp(word, "LINEAR") == 0 ? LINEAR
             : strcmp(word, "STEP") == 0          ? STEP
             : strcmp(word, "CUBICSPLINE") == 0   ? CUBIC
                                                  : (interpolation)-1;
    if ((int)t->how >= 0)
        return true;
    json_fail(sampler, "expected \"interpolation\" LINEAR, STEP or CUBICSPLINE, found %s",
              word);
    return false;
}

static bool all_finite(const float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

/* @param width numbers of a value; 0: as many as there are for each key */
static bool check_counts(const json_value *sampler, track *t, size_t n_numbers)
{
    size_t each = t->how == CUBIC ? 3 : 1;
    if (t->n > 0 && t->width == 0)
        t->width = n_numbers / (each * t->n);
    if (t->n == 0 || t->width == 0 || n_numbers != each * t->n * t->width)
        json_fail(sampler, "expected %zu values for each of %zu keys, found %zu numbers",
                  each, t->n, n_numbers);
    else if (!all_finite(t->times, t->n) || !all_finite(t->values, n_numbers))
        json_fail(sampler, "expected finite numbers in its accessors");
    else
        return true;
    return false;
}

/* @param components of an element of its values */
static bool read_track(gltf *g, const json_value *sampler, unsigned components, track *t)
{
    size_t n_elements = 0;
    gint64 input = json_whole(sampler, "input", GLTF_MOST);
    gint64 output = json_whole(sampler, "output", GLTF_MOST);
    if (!read_how(sampler, t))
        return false;
    if (input < 0 || output < 0) {
        json_fail(sampler, "expected \"input\" and \"output\"");
        return false;
    }
    t->times = gltf_read_floats(g, input, 1, 0, &t->n);
    t->values = t->times ? gltf_read_floats(g, output, components, 0, &n_elements) : NULL;
    return t->values && check_counts(sampler, t, n_elements * components);
}

static void track_clear(track *t)
{
    big_free(t->times);
    big_free(t->values);
}

static void take(gltf_moved *to, const track *t, const char *path, double time)
{
    const moment m = moment_at(t, time);
    double *numbers = strcmp(path, "translation") == 0 ? to->translation
                      : strcmp(path, "scale") == 0     ? to->scale
                                                       : to->rotation;
    if (strcmp(path, "weights") == 0) {
        g_free(to->weights);
        to->n_weights = (guint)t->width;
        numbers = to->weights = g_new0(double, t->width);
    }
    to->has_translation |= numbers == to->translation;
    to->has_scale |= numbers == to->scale;
    to->has_rotation |= numbers == to->rotation;
    if (numbers == to->rotation && t->how == LINEAR)
        sample_turn(t, &m, numbers);
    else
        for (size_t i = 0; i < t->width; i++)
            numbers[i] = sample(t, &m, i);
}

/* What a channel moves; 0: nothing that is known here. */
static unsigned components_of(const char *path)
{
    return !path                                                            ? 0
           : strcmp(path, "rotation") == 0                                  ? 4
           : strcmp(path, "translation") == 0 || strcmp(path, "scale") == 0 ? 3
           : strcmp(path, "weights") == 0                                   ? 1
                                                                            : 0;
}

static void read_channel(gltf *g, const json_value *samplers, const json_value *channel)
{
    json_value target = json_member(channel, "target");
    const char *path = json_text(&target, "path");
    gint64 node = json_whole(&target, "node", (gint64)g->n_nodes - 1);
    gint64 number = json_whole(channel, "sampler", GLTF_MOST);
    unsigned components = components_of(path);
    if (gltf_failed(g) || node < 0 || components == 0)
        return;
    if (number < 0) {
        json_fail(channel, "expected a \"sampler\"");
        return;
    }
    json_value sampler = json_element(samplers, (guint)number);
    track t = {.width = components == 1 ? 0 : components};
    if (!gltf_failed(g) && read_track(g, &sampler, components, &t))
        take(&g->moved[node], &t, path, g->builder->time);
    track_clear(&t);
}

void gltf_read_animations(gltf *g)
{
    json_value animations = json_member(&g->root, "animations");
    guint n = json_length(&animations);
    if (n == 0 || gltf_failed(g))
        return;
    g->builder->scene->is_animated = true;
    if (!g->builder->at_time) {
        gltf_note(g, LOG_NOTE, "animations are left out: the scene stands as it begins");
        return;
    }
    if (n > 1)
        gltf_note(g, LOG_NOTE, "of %u animations the first is taken", n);
    json_value first = json_element(&animations, 0);
    json_value channels = json_member(&first, "channels");
    json_value samplers = json_member(&first, "samplers");
    guint n_channels = json_length(&channels);
    g->moved = g_new0(gltf_moved, g->n_nodes + 1);
    for (guint i = 0; i < n_channels && !gltf_failed(g); i++) {
        json_value channel = json_element(&channels, i);
        read_channel(g, &samplers, &channel);
    }
}

void gltf_forget_animations(gltf *g)
{
    for (guint i = 0; g->moved && i < g->n_nodes; i++)
        g_free(g->moved[i].weights);
    g_clear_pointer(&g->moved, g_free);
}
