/*
 * The current transform: each directive multiplies it from the right, so the transform
 * written last acts on a point first. There are two, at a start and an end time; unless
 * ActiveTransform says otherwise a directive acts on both, and nothing moves.
 */
#include "format/pbrt/pbrt_parser.h"

#include "format/number.h"

#include <math.h>

static bool read_numbers(pbrt_parser *parser, double *out, int n)
{
    for (int i = 0; i < n; i++) {
        token t = lexer_peek(parser->words);
        if (t.kind != TOKEN_WORD || (!number_double(t.text, t.length, &out[i]) &&
                                     !pbrt_v3_number(parser, &t, &out[i])))
            return pbrt_expected(parser, "a number", &t);
        lexer_next(parser->words);
    }
    return true;
}

static bool read_bracket(pbrt_parser *parser, token_kind kind, const char *what)
{
    token t = lexer_peek(parser->words);
    if (t.kind != kind)
        return pbrt_expected(parser, what, &t);
    lexer_next(parser->words);
    return true;
}

/** Sixteen numbers, column by column. They may flatten: meshes stand that. */
static bool read_matrix(pbrt_parser *parser, transform *out)
{
    double v[16], m[4][4];
    if (!read_bracket(parser, TOKEN_LEFT, "'['") || !read_numbers(parser, v, 16) ||
        !read_bracket(parser, TOKEN_RIGHT, "']' after 16 numbers"))
        return false;
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            m[row][column] = v[4 * column + row];
    transform_from_any_matrix((const double(*)[4])m, out);
    return true;
}

static bool is_finite(const transform *t)
{
    double sum = 0.0;
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            sum += fabs(t->m[row][column]) + fabs(t->inverse[row][column]);
    return isfinite(sum);
}

/** Takes new values of the active transforms. */
static void set_ctm(pbrt_parser *parser, source_place place, const transform_pair *t)
{
    graphics_state *state = &parser->state;
    bool fine = (!(state->active & ACTIVE_START) || is_finite(&t->start)) &&
                (!(state->active & ACTIVE_END) || is_finite(&t->end));
    if (!fine) {
        pbrt_error(parser, place,
                   "expected a transform of finite numbers, found one out of range");
        return;
    }
    if (state->active & ACTIVE_START)
        state->ctm = t->start;
    if (state->active & ACTIVE_END)
        state->ctm_end = t->end;
}

static void multiply(pbrt_parser *parser, source_place place, const transform *t)
{
    const transform_pair product = {transform_multiply(&parser->state.ctm, t),
                                    transform_multiply(&parser->state.ctm_end, t)};
    set_ctm(parser, place, &product);
}

bool pbrt_is_flat(const pbrt_parser *parser)
{
    return !transform_can_invert(&parser->state.ctm) ||
           !transform_can_invert(&parser->state.ctm_end);
}

bool pbrt_is_moving(const pbrt_parser *parser)
{
    return !transform_equal(&parser->state.ctm, &parser->state.ctm_end);
}

motion pbrt_motion(const pbrt_parser *parser)
{
    return motion_make(&parser->state.ctm, &parser->state.ctm_end, parser->times[0],
                       parser->times[1]);
}

bool pbrt_identity(pbrt_parser *parser, source_place place)
{
    const transform_pair identity = {transform_identity(), transform_identity()};
    set_ctm(parser, place, &identity);
    return true;
}

bool pbrt_translate(pbrt_parser *parser, source_place place)
{
    double v[3];
    if (!read_numbers(parser, v, 3))
        return false;
    transform t = transform_translate(v[0], v[1], v[2]);
    multiply(parser, place, &t);
    return true;
}

bool pbrt_scale(pbrt_parser *parser, source_place place)
{
    double v[3];
    if (!read_numbers(parser, v, 3))
        return false;
    const double m[4][4] = {{v[0]}, {0.0, v[1]}, {0.0, 0.0, v[2]}, {0.0, 0.0, 0.0, 1.0}};
    transform t;
    transform_from_any_matrix(m, &t);
    multiply(parser, place, &t);
    return true;
}

bool pbrt_rotate(pbrt_parser *parser, source_place place)
{
    double v[4];
    if (!read_numbers(parser, v, 4))
        return false;
    if (!(hypot(hypot(v[1], v[2]), v[3]) > 0.0)) {
        pbrt_warning(parser, place, "Rotate about an axis 0 0 0 turns nothing");
        return true;
    }
    transform t = transform_rotate(v[0], v[1], v[2], v[3]);
    multiply(parser, place, &t);
    return true;
}

bool pbrt_look_at(pbrt_parser *parser, source_place place)
{
    double v[9];
    if (!read_numbers(parser, v, 9))
        return false;
    transform t;
    if (transform_look_at(v, v + 3, v + 6, &t))
        multiply(parser, place, &t);
    else if (parser->is_v3)
        pbrt_warning(parser, place,
                     "LookAt along its up direction or nowhere turns nothing");
    else
        pbrt_error(parser, place,
                   "expected an eye apart from the target and an up direction across "
                   "the view, found neither or one of them missing");
    return true;
}

bool pbrt_transform(pbrt_parser *parser, source_place place)
{
    transform t;
    if (!read_matrix(parser, &t))
        return false;
    set_ctm(parser, place, &(const transform_pair){t, t});
    return true;
}

bool pbrt_concat_transform(pbrt_parser *parser, source_place place)
{
    transform t;
    if (!read_matrix(parser, &t))
        return false;
    multiply(parser, place, &t);
    return true;
}

void pbrt_name_transform(pbrt_parser *parser, const char *name, const transform *start,
                         const transform *end)
{
    transform_pair *copy = g_new(transform_pair, 1);
    *copy = (transform_pair){*start, *end};
    g_hash_table_insert(parser->coordinate_systems, g_strdup(name), copy);
}

bool pbrt_coordinate_system(pbrt_parser *parser, source_place place)
{
    (void)place;
    g_autofree char *name = pbrt_read_string(parser, "a name", NULL);
    if (!name)
        return false;
    pbrt_name_transform(parser, name, &parser->state.ctm, &parser->state.ctm_end);
    return true;
}

bool pbrt_coord_sys_transform(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a name", &at);
    if (!name)
        return false;
    const transform_pair *t = g_hash_table_lookup(parser->coordinate_systems, name);
    if (t)
        set_ctm(parser, place, t);
    else
        pbrt_warning(parser, at,
                     "there is no coordinate system \"%s\"; the one before stays", name);
    return true;
}

bool pbrt_transform_times(pbrt_parser *parser, source_place place)
{
    double times[2];
    if (!read_numbers(parser, times, 2))
        return false;
    if (!(times[1] > times[0]) || !isfinite(times[0]) || !isfinite(times[1])) {
        pbrt_error(
            parser, place,
            "expected a start time before the end time, found TransformTimes %g %g",
            times[0], times[1]);
        return true;
    }
    parser->times[0] = times[0];
    parser->times[1] = times[1];
    return true;
}

bool pbrt_active_transform(pbrt_parser *parser, source_place place)
{
    static const struct {
        const char *name;
        active_transforms active;
    } words[] = {
        {"All", ACTIVE_ALL}, {"StartTime", ACTIVE_START}, {"EndTime", ACTIVE_END}};
    (void)place;
    token t = lexer_peek(parser->words);
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++) {
        if (token_is(&t, words[i].name)) {
            parser->state.active = words[i].active;
            lexer_next(parser->words);
            return true;
        }
    }
    return pbrt_expected(parser, "All, StartTime or EndTime", &t);
}
