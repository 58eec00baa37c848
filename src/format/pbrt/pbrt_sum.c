#include "format/pbrt/pbrt_sum.h"

#include "format/lexer.h"

/* Before WorldBegin transformations place the camera. */
static const char *const about_seeing[] = {"Camera",
                                           "Film",
                                           "Sampler",
                                           "Integrator",
                                           "LookAt",
                                           "PixelFilter",
                                           "Accelerator",
                                           "Translate",
                                           "Scale",
                                           "Rotate",
                                           "Transform",
                                           "ConcatTransform",
                                           "Identity",
                                           "CoordinateSystem",
                                           "CoordSysTransform",
                                           NULL};

static bool is_directive(const token *t)
{
    return t->kind == TOKEN_WORD && t->length > 0 && g_ascii_isupper(t->text[0]);
}

static bool is_about_seeing(const token *t)
{
    g_autofree char *word = g_strndup(t->text, t->length);
    return g_strv_contains(about_seeing, word);
}

static void add_token(GChecksum *sum, const token *t)
{
    const char kind = (char)('0' + (int)t->kind);
    g_checksum_update(sum, (const guchar *)&kind, 1);
    g_checksum_update(sum, (const guchar *)t->text, (gssize)t->length);
    g_checksum_update(sum, (const guchar *)"\n", 1);
}

void pbrt_sum_world(GChecksum *sum, const char *data, size_t size)
{
    lexer words = lexer_new("", data, size);
    bool in_world = false, is_left_out = false;
    for (token t; (t = lexer_next(&words)).kind != TOKEN_END;) {
        in_world |= token_is(&t, "WorldBegin");
        if (is_directive(&t))
            is_left_out = !in_world && is_about_seeing(&t);
        if (!is_left_out)
            add_token(sum, &t);
        if (t.kind == TOKEN_UNTERMINATED)
            break;
    }
}
