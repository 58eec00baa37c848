#include "texture/texels.h"

#include "base/memory.h"
#include "base/wanted.h"

#include <string.h>

/* Slots of a hash table of a channel's values, four times as many as it may hold. */
enum { SLOTS = 4 * TEXEL_CODES };

/* The values of a channel met so far, by their bits. */
typedef struct code_book {
    int n;
    uint32_t bits[SLOTS];
    uint16_t code[SLOTS]; /* plus one; 0: the slot is free */
} code_book;

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The code of a value, a new one if it is new; -1: there are too many values. */
static int code_of(code_book *book, float value, float table[TEXEL_CODES])
{
    uint32_t bits = bits_of(value);
    uint32_t slot = bits * 2654435769u >> 22; /* the upper ten bits */
    while (book->code[slot] > 0 && book->bits[slot] != bits)
        slot = (slot + 1) % SLOTS;
    if (book->code[slot] == 0) {
        if (book->n == TEXEL_CODES)
            return -1;
        table[book->n++] = value;
        book->bits[slot] = bits;
        book->code[slot] = (uint16_t)book->n;
    }
    return book->code[slot] - 1;
}

/* @return false: some channel has too many values */
static bool encode_with(texels *t, const float *pixels, code_book *books)
{
    int n = t->n_channels;
    uint8_t *to = t->codes;
    for (size_t i = 0; i < texels_count(t) && still_wanted_at(i, NULL);
         i++, pixels += n, to += n)
        for (int c = 0; c < n; c++) {
            int code = code_of(&books[c], pixels[c], t->tables[c]);
            if (code < 0)
                return false;
            to[c] = (uint8_t)code;
        }
    return true;
}

static void free_codes(texels *t)
{
    big_free(t->codes);
    big_free(t->tables);
    t->codes = NULL;
    t->tables = NULL;
}

/* @return false: memory is refused; no codes: some channel has too many values */
static bool encode(texels *t, const float *pixels, GError **error)
{
    size_t n = (size_t)t->n_channels;
    code_book *books = big_alloc(n, sizeof *books, "a picture", error);
    t->codes = books
                   ? big_alloc(texels_count(t) * n, sizeof *t->codes, "a picture", error)
                   : NULL;
    t->tables = t->codes ? big_alloc(n, sizeof *t->tables, "a picture", error) : NULL;
    bool done = t->tables != NULL;
    if (done && !encode_with(t, pixels, books))
        free_codes(t);
    big_free(books);
    return done;
}

texels *texels_from_image(image *taken, GError **error)
{
    texels *t = g_new0(texels, 1);
    t->width = taken->width;
    t->height = taken->height;
    t->n_channels = taken->n_channels;
    bool done = encode(t, taken->pixels, error);
    if (done && !t->codes)
        t->values = g_steal_pointer(&taken->pixels);
    image_free(taken);
    if (done)
        return t;
    texels_free(t);
    return NULL;
}

texels *texels_mended(const texels *t, float (*mend)(float), GError **error)
{
    texels *copy = g_new0(texels, 1);
    size_t n_channels = (size_t)t->n_channels, n = texels_count(t) * n_channels;
    copy->width = t->width;
    copy->height = t->height;
    copy->n_channels = t->n_channels;
    copy->values = big_alloc(n, sizeof *copy->values, "a picture", error);
    if (!copy->values) {
        texels_free(copy);
        return NULL;
    }
    for (size_t i = 0; i < n && still_wanted_at(i, NULL); i++)
        copy->values[i] = mend(texels_value(t, i / n_channels, (int)(i % n_channels)));
    return copy;
}

/* The source texels that a texel of the smaller image covers, of n for n / 2 rounded up.
 */
static void children(int i, int n, size_t out[2])
{
    out[0] = 2 * (size_t)i;
    out[1] = MIN(out[0] + 1, (size_t)n - 1);
}

static void fill_halved(texels *small, const texels *large)
{
    size_t width = (size_t)large->width;
    float *to = small->values;
    for (int y = 0; y < small->height && still_wanted(NULL); y++)
        for (int x = 0; x < small->width; x++, to += small->n_channels) {
            size_t xs[2], ys[2];
            children(x, large->width, xs);
            children(y, large->height, ys);
            for (int c = 0; c < small->n_channels; c++)
                to[c] = 0.25f * (texels_value(large, ys[0] * width + xs[0], c) +
                                 texels_value(large, ys[0] * width + xs[1], c) +
                                 texels_value(large, ys[1] * width + xs[0], c) +
                                 texels_value(large, ys[1] * width + xs[1], c));
        }
}

texels *texels_halved(const texels *large, GError **error)
{
    texels *t = g_new0(texels, 1);
    t->width = (large->width + 1) / 2;
    t->height = (large->height + 1) / 2;
    t->n_channels = large->n_channels;
    size_t n = texels_count(t) * (size_t)t->n_channels;
    t->values = big_alloc(n, sizeof *t->values, "a picture", error);
    if (!t->values) {
        texels_free(t);
        return NULL;
    }
    fill_halved(t, large);
    return t;
}

void texels_free(texels *t)
{
    if (!t)
        return;
    free_codes(t);
    big_free(t->values);
    g_free(t);
}
