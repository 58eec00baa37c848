/*
 * Writing records (format/model/stream.h) to a pipe. Who can not write has nobody to
 * tell: the process ends.
 */
#pragma once

#include "format/model/stream.h"

#include <stddef.h>

typedef struct out {
    int file;
    uint64_t size; /**< of the record that is open */
    size_t n;      /**< bytes in the buffer */
    unsigned char buffer[1 << 16];
} out;

void out_begin(out *o, stream_kind kind, uint64_t size);
void out_bytes(out *o, const void *bytes, size_t size);
/** @brief Of a record, whose bytes are all written. */
void out_end(out *o);
void out_flush(out *o);

/** @brief A record that is one struct. */
void out_struct(out *o, stream_kind kind, const void *value, size_t size);
void out_note(out *o, stream_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/** @brief Says why there is no model, and ends the process. */
_Noreturn void out_fail(out *o, stream_reason reason, const char *text);
/** @brief Says that all is said, and ends the process. */
_Noreturn void out_finish(out *o);
