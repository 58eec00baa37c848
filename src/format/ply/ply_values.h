/*
 * The values of a PLY file's body, one at a time, whatever their encoding.
 */
#pragma once

#include "format/ply/ply_header.h"
#include "shape/shape.h"

/** @brief Where the reading of a file stands. */
typedef struct ply_reader {
    const char *file;
    ply_header header;
    const char *begin, *at, *end;
    const char *line_start; /**< of text */
    int line;
    bool swap; /**< bytes are in the other order than ours */
    mesh m;
    size_t n_vertices, capacity; /**< capacity: indices there is room for */
} ply_reader;

/** @brief An error where the reading stands: at a line of text, at a byte of binary data.
 *  @return false */
bool ply_fail(const ply_reader *r, GError **error, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/** @brief Bytes not read yet. */
size_t ply_remaining(const ply_reader *r);
/** @brief A number of binary data; its bytes must be there. */
double ply_load(const char *from, ply_type type, bool swap);
/** @brief The next number. */
bool ply_read_number(ply_reader *r, ply_type type, double *out, GError **error);
/** @brief The length that a list property begins with. */
bool ply_read_length(ply_reader *r, const ply_property *p, size_t *n, GError **error);
/** @brief Passes over a number or a list. */
bool ply_skip_property(ply_reader *r, const ply_property *p, GError **error);
