/*
 * The current transform: each directive multiplies it from the right, so the transform
 * written last acts on a point first.
 */
#include "format/pbrt_parser.h"

#include "format/number.h"

#include <math.h>

static bool read_numbers(pbrt_parser *parser, double *out, int n)
{
    for (int i = 0; i < n; i++) {
        token t = lexer_peek(parser->words);
        if (t.kind != TOKEN_WORD || !number_double(t.text, t.length, &out[i]))
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

/** Sixteen numbers, column by column. *is_singular is told apart: it is no grammar. */
static bool read_matrix(pbrt_parser *parser, transform *out, bool *is_singular)
{
    double v[16], m[4][4];
    if (!read_bracket(parser, TOKEN_LEFT, "'['") || !read_numbers(parser, v, 16) ||
        !read_bracket(parser, TOKEN_RIGHT, "']' after 16 numbers"))
        return false;
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            m[row][column] = v[4 * column + row];
    *is_singular = !transform_from_matrix((const double(*)[4])m, out);
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

static void set_ctm(pbrt_parser *parser, source_place place, const transform *t)
{
    if (parser->state.is_animated)
        pbrt_error(parser, place,
                   "expected 'ActiveTransform All', found a transform of one time only: "
                   "motion is not supported");
    else if (!is_finite(t))
        pbrt_error(parser, place,
                   "expected a transform that can be inverted, found one "
                   "out of range");
    else
        parser->state.ctm = *t;
}

static void multiply(pbrt_parser *parser, source_place place, const transform *t)
{
    transform product = transform_multiply(&parser->state.ctm, t);
    set_ctm(parser, place, &product);
}

bool pbrt_identity(pbrt_parser *parser, source_place place)
{
    transform t = transform_identity();
    set_ctm(parser, place, &t);
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
    if (!(fabs(v[0]) > 0.0 && fabs(v[1]) > 0.0 && fabs(v[2]) > 0.0)) {
        pbrt_error(parser, place, "expected factors other than 0, found Scale %g %g %g",
                   v[0], v[1], v[2]);
        return true;
    }
    transform t = transform_scale(v[0], v[1], v[2]);
    multiply(parser, place, &t);
    return true;
}

bool pbrt_rotate(pbrt_parser *parser, source_place place)
{
    double v[4];
    if (!read_numbers(parser, v, 4))
        return false;
    if (!(hypot(hypot(v[1], v[2]), v[3]) > 0.0)) {
        pbrt_error(parser, place, "expected an axis with a direction, found 0 0 0");
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
    else
        pbrt_error(parser, place,
                   "expected an eye apart from the target and an up direction across "
                   "the view, found neither or one of them missing");
    return true;
}

bool pbrt_transform(pbrt_parser *parser, source_place place)
{
    transform t;
    bool is_singular;
    if (!read_matrix(parser, &t, &is_singular))
        return false;
    if (is_singular)
        pbrt_error(parser, place,
                   "expected a matrix that can be inverted, found a "
                   "singular one");
    else
        set_ctm(parser, place, &t);
    return true;
}

bool pbrt_concat_transform(pbrt_parser *parser, source_place place)
{
    transform t;
    bool is_singular;
    if (!read_matrix(parser, &t, &is_singular))
        return false;
    if (is_singular)
        pbrt_error(parser, place,
                   "expected a matrix that can be inverted, found a "
                   "singular one");
    else
        multiply(parser, place, &t);
    return true;
}

void pbrt_name_transform(pbrt_parser *parser, const char *name, const transform *t)
{
    transform *copy = g_new(transform, 1);
    *copy = *t;
    g_hash_table_insert(parser->coordinate_systems, g_strdup(name), copy);
}

bool pbrt_coordinate_system(pbrt_parser *parser, source_place place)
{
    (void)place;
    g_autofree char *name = pbrt_read_string(parser, "a name", NULL);
    if (!name)
        return false;
    pbrt_name_transform(parser, name, &parser->state.ctm);
    return true;
}

bool pbrt_coord_sys_transform(pbrt_parser *parser, source_place place)
{
    source_place at = place;
    g_autofree char *name = pbrt_read_string(parser, "a name", &at);
    if (!name)
        return false;
    const transform *t = g_hash_table_lookup(parser->coordinate_systems, name);
    if (t)
        set_ctm(parser, place, t);
    else
        pbrt_error(parser, at, "expected the name of a coordinate system, found \"%s\"",
                   name);
    return true;
}

bool pbrt_transform_times(pbrt_parser *parser, source_place place)
{
    (void)place;
    double times[2];
    return read_numbers(parser, times, 2);
}

bool pbrt_active_transform(pbrt_parser *parser, source_place place)
{
    (void)place;
    token t = lexer_peek(parser->words);
    bool is_all = token_is(&t, "All");
    if (!is_all && !token_is(&t, "StartTime") && !token_is(&t, "EndTime"))
        return pbrt_expected(parser, "All, StartTime or EndTime", &t);
    lexer_next(parser->words);
    parser->state.is_animated = !is_all;
    return true;
}
