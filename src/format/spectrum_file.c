/*
 * Spectra in files.
 */
#include "format/spectrum_file.h"

#include "base/input.h"
#include "color/curve.h"
#include "format/lexer.h"
#include "format/number.h"

static bool read_pairs(lexer *words, GArray *numbers, GError **error)
{
    for (;;) {
        token t = lexer_next(words);
        float value;
        if (t.kind == TOKEN_END && numbers->len > 0 && numbers->len % 2 == 0)
            return true;
        if (t.kind != TOKEN_WORD || !number_float(t.text, t.length, &value)) {
            /* not quoted: a scene may name any file */
            error_at(error, t.place, "expected %s, found %s",
                     numbers->len % 2 ? "a value" : "a wavelength in nm",
                     t.kind == TOKEN_END ? "the end of the file" : "something else");
            return false;
        }
        if (numbers->len >= 2 * CURVE_MOST_POINTS) {
            error_at(error, t.place, "expected at most %d wavelengths, found more",
                     CURVE_MOST_POINTS);
            return false;
        }
        g_array_append_val(numbers, value);
    }
}

GArray *spectrum_file_read(const char *path, source_place place, GError **error)
{
    input in;
    GError *inner = NULL;
    if (!input_open(&in, path, &inner)) {
        error_move_at(error, place, inner);
        return NULL;
    }
    lexer words = lexer_new(path, in.data, in.size);
    g_autoptr(GArray) numbers = g_array_new(FALSE, FALSE, sizeof(float));
    bool fine = read_pairs(&words, numbers, error);
    input_close(&in);
    return fine ? g_steal_pointer(&numbers) : NULL;
}
