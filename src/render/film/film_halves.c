#include "render/film/film_halves.h"

#include "base/memory.h"

static size_t n_pixels(const film *f)
{
    return (size_t)f->width * (size_t)f->height;
}

bool halves_open(film *f, GError **error)
{
    f->pass_guides = big_alloc(n_pixels(f), sizeof *f->pass_guides, "the film", error);
    if (f->pass_guides)
        f->halves = big_alloc(n_pixels(f), sizeof *f->halves, "the film", error);
    return f->halves != NULL;
}

void halves_clear(film *f)
{
    big_free(f->pass_guides);
    big_free(f->halves);
}

size_t film_guide_bytes(void)
{
    return sizeof(struct guide_sum);
}

/* ---- Sums ---- */

static void add_xyz(float sum[3], const wavelengths *w, spectrum value, float weight)
{
    float xyz[3];
    spectrum_to_xyz(w, value, xyz);
    for (int i = 0; i < 3; i++)
        sum[i] += xyz[i] * weight;
}

void guide_add(guide_sum *sum, const film_pass *pass, const radiance_sample *sample,
               float weight)
{
    const light_guide *guide = &sample->guide;
    const spectrum in_sight = sample->layers[LAYER_EMISSION] + guide->lights;
    add_xyz(sum->lights, pass->w, guide->lights, weight);
    add_xyz(sum->glints, pass->w, guide->glints, weight);
    sum->lit += spectrum_is_black(in_sight) ? 0.0f : weight;
    if (!(guide->weight > 0.0f))
        return;
    float share = weight / guide->weight;
    add_xyz(sum->albedo, pass->w, guide->albedo * pass->white, share);
    for (int i = 0; i < 3; i++)
        sum->normal[i] += guide->normal[i] * share;
    sum->depth += guide->depth * share;
}

void halves_put(film *f, int x, int y, const guide_sum *sum)
{
    if (f->halves)
        f->pass_guides[(size_t)(y - f->y0) * (size_t)f->width + (size_t)(x - f->x0)] =
            *sum;
}

static void add_floats(void *to, const void *from, int n)
{
    float *sum = to;
    const float *number = from;
    for (int i = 0; i < n; i++)
        sum[i] += number[i];
}

/* What of a layer is not filtered with it: lights in mirrors, which are in sight too, and
   glints. */
static double luminance_apart(const guide_sum *guides, int layer)
{
    if (layer != LAYER_SPECULAR)
        return 0.0;
    return (double)guides->lights[FILM_Y] + (double)guides->glints[FILM_Y];
}

void halves_end_pass(const film *f, size_t begin, size_t end)
{
    for (size_t i = begin; i < end && f->halves; i++) {
        half_pixel *pixel = &f->halves[i];
        const float *number = f->pass[i].number;
        double w = fabs((double)number[HALF_AT(weight)]);
        add_floats(&pixel->guides, &f->pass_guides[i], GUIDE_NUMBERS);
        for (size_t l = 0; l < N_LIGHTS; l++) {
            double y = (double)number[HALF_AT(color) + 3 * l + FILM_Y];
            y -= luminance_apart(&f->pass_guides[i], (int)l);
            pixel->y2[l] += w > 0.0 ? y * y / w : 0.0;
        }
        if (f->n_passes % 2 == 0) {
            add_floats(&pixel->even, number, FILM_NUMBERS);
            add_floats(&pixel->guides_even, &f->pass_guides[i], GUIDE_NUMBERS);
        }
    }
}

/* ---- Halves of a pixel ---- */

/* Whether the pass under way counts at a pixel, and is an even or an odd one. */
static bool has_pass(const film *f, size_t i, bool odd)
{
    return f->n_cells > 0 && odd == (f->n_passes % 2 == 1) && film_pass_counts(f, i);
}

/* Of two rows the one whose pixels are of that half. */
static size_t row_of(const film *f, size_t y, int half)
{
    size_t row = y - y % 2 + (size_t)half;
    return row < (size_t)f->height ? row : row - 2;
}

static bool is_among(const size_t *pixels, int n, size_t i)
{
    for (int k = 0; k < n; k++)
        if (pixels[k] == i)
            return true;
    return false;
}

/* Of a first pass that is not whole: itself, or of those that stand for it one in its
   row. */
static size_t place_in_part(const film *f, size_t x, size_t row)
{
    size_t i = row * (size_t)f->width + x, from[4];
    bool is_last = x + 1 == (size_t)f->width, is_left = x % 2 == 1 || is_last;
    if (film_pass_counts(f, i))
        return i;
    size_t first = is_left ? i - 1 : i + 1, second = is_left ? i + 1 : i - 1;
    int n = film_pixels_for(f, i, from);
    bool goes_on = !is_among(from, n, first) && is_among(from, n, second);
    return goes_on ? second : first;
}

bool halves_have(const film *f)
{
    bool has_pairs = f->width > 1 && f->height > 1;
    bool has_some = f->n_passes > 0 || f->n_cells >= HALVES_CELLS;
    return f->n_passes > 1 || (f->lends && has_pairs && has_some);
}

static half_view view_at(const film *f, size_t i, bool odd)
{
    const half_pixel *pixel = &f->halves[i];
    return (half_view){
        .i = i,
        .odd = odd,
        .all = (const double *)&f->pixels[i].sum,
        .even = pixel->even.number,
        .pass = has_pass(f, i, odd) ? f->pass[i].number : NULL,
        .guides = {(const float *)&pixel->guides, (const float *)&pixel->guides_even},
        .pass_guides = (const float *)&f->pass_guides[i],
    };
}

half_view half_view_of(const film *f, size_t i, int half)
{
    if (f->n_passes > 1 || has_pass(f, i, true))
        return view_at(f, i, half == 1);
    size_t x = i % (size_t)f->width, row = row_of(f, i / (size_t)f->width, half);
    if (f->n_passes == 0)
        return view_at(f, place_in_part(f, x, row), false);
    i = row * (size_t)f->width + x;
    return view_at(f, i, half == 1 && has_pass(f, i, true));
}

/* Each pass has the more the less it weighs. */
float halves_variance(const film *f, size_t i, int layer)
{
    const film_sum *sum = &f->pixels[i].sum;
    double y = sum->color[layer][FILM_Y], w = fabs(sum->weight);
    y -= luminance_apart(&f->halves[i].guides, layer);
    double y2 = f->halves[i].y2[layer], n = (double)f->n_passes;
    if (f->n_cells > 0 && film_pass_counts(f, i)) {
        film_sum pass = {0};
        film_add_pass(&pass, &f->pass[i]);
        double more = pass.color[layer][FILM_Y], by = fabs(pass.weight);
        more -= luminance_apart(&f->pass_guides[i], layer);
        y += more;
        w += by;
        y2 += by > 0.0 ? more * more / by : 0.0;
        n += 1.0;
    }
    if (n < 2.0)
        return NAN;
    if (!(w > 0.0))
        return 0.0f;
    double scatter = fmax(y2 - y * y / w, 0.0);
    double scale2 = (double)f->scale * (double)f->scale;
    return (float)(scale2 * scatter / (w * (n - 1.0)));
}
