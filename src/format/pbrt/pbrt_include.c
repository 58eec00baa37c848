/*
 * Another file in place of the directive that names it.
 */
#include "format/pbrt/pbrt_parser.h"

#include "base/input.h"

#include <string.h>

static bool is_open(const pbrt_parser *parser, const char *path)
{
    for (guint i = 0; i < parser->open_files->len; i++)
        if (strcmp(parser->open_files->pdata[i], path) == 0)
            return true;
    return false;
}

void pbrt_read_file(pbrt_parser *parser, const char *name, source_place place,
                    void (*read)(pbrt_parser *parser, lexer *words, void *data),
                    void *data)
{
    g_autofree char *path = g_canonicalize_filename(name, parser->base_directory);
    if (is_open(parser, path)) {
        pbrt_error(parser, place, "expected a file that is not being read, found \"%s\"",
                   name);
        return;
    }
    if (parser->open_files->len >= MAX_DEPTH) {
        pbrt_error(parser, place,
                   "expected at most %d files within each other, found "
                   "\"%s\"",
                   MAX_DEPTH, name);
        return;
    }
    input in;
    GError *inner = NULL, *error = NULL;
    scene_sources_add(parser->builder->build.sources, path);
    if (!input_open(&in, path, &inner)) {
        error_move_at(&error, place, inner);
        pbrt_report(parser, error);
        return;
    }
    lexer words = lexer_new(path, in.data, in.size);
    g_ptr_array_add(parser->open_files, path);
    read(parser, &words, data);
    g_ptr_array_remove_index(parser->open_files, parser->open_files->len - 1);
    input_close(&in);
}
