/*
 * The header of a PLY file: what elements follow, and how they are stored.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>

typedef enum ply_type {
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64,
} ply_type;

typedef enum ply_encoding { PLY_TEXT, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } ply_encoding;

typedef struct ply_property {
    char name[40];
    ply_type type; /**< of the value, or of a list's items */
    bool is_list;
    ply_type count_type; /**< of a list's length */
} ply_property;

typedef struct ply_element {
    char name[40];
    size_t count;
    GArray *properties; /**< of ply_property */
} ply_element;

typedef struct ply_header {
    ply_encoding encoding;
    GArray *elements; /**< of ply_element */
    size_t size;      /**< bytes, up to the first element */
    int n_lines;
} ply_header;

/** @brief Reads a header from the beginning of size bytes.
 *  @param file named in errors: "FILE:LINE:COLUMN: ..." */
bool ply_header_read(ply_header *header, const char *file, const char *data, size_t size,
                     GError **error);
void ply_header_clear(ply_header *header);

size_t ply_type_size(ply_type type);
/** @brief Index of a property of the element, -1 if it has none of that name. */
int ply_find_property(const ply_element *e, const char *name);
/** @brief Fewest bytes that one row of the element takes in the file. */
size_t ply_least_row(const ply_header *header, const ply_element *e);

static inline const ply_element *ply_element_at(const ply_header *header, guint i)
{
    return &g_array_index(header->elements, ply_element, i);
}

static inline const ply_property *ply_property_at(const ply_element *e, guint i)
{
    return &g_array_index(e->properties, ply_property, i);
}
