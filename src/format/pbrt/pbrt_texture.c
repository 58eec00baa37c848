/*
 * Textures, given to the scene.
 */
#include "format/pbrt/pbrt_parser.h"

#include "format/lenient.h"

void pbrt_make_texture(pbrt_parser *parser, const char *name, bool is_spectrum,
                       const char *kind, const params *p)
{
    GError *error = NULL;
    g_autoptr(params) replaced =
        lenient_texture(&parser->builder->build, &kind, is_spectrum, p, &error);
    const params *given = replaced ? replaced : p;
    if (!error &&
        builder_add_texture(parser->builder, name, kind, is_spectrum, given, &error))
        pbrt_check_used(parser, given, "texture", kind);
    else
        pbrt_report(parser, error);
}
