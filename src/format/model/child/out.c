#include "format/model/child/out.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { UNWRITTEN = 3, LONGEST_NOTE = 2000 };

void out_flush(out *o)
{
    for (size_t done = 0; done < o->n;) {
        ssize_t n = write(o->file, o->buffer + done, o->n - done);
        if (n < 0 && errno != EINTR)
            _exit(UNWRITTEN);
        done += n > 0 ? (size_t)n : 0;
    }
    o->n = 0;
}

void out_bytes(out *o, const void *bytes, size_t size)
{
    const unsigned char *from = bytes;
    while (size > 0) {
        size_t room = sizeof o->buffer - o->n, some = size < room ? size : room;
        memcpy(o->buffer + o->n, from, some);
        o->n += some;
        from += some;
        size -= some;
        if (o->n == sizeof o->buffer)
            out_flush(o);
    }
}

void out_begin(out *o, stream_kind kind, uint64_t size)
{
    const stream_head head = {.kind = kind, .size = size};
    o->size = size;
    out_bytes(o, &head, sizeof head);
}

void out_end(out *o)
{
    static const char padding[8] = {0};
    out_bytes(o, padding, -o->size & 7);
}

void out_struct(out *o, stream_kind kind, const void *value, size_t size)
{
    out_begin(o, kind, size);
    out_bytes(o, value, size);
    out_end(o);
}

void out_note(out *o, stream_level level, const char *format, ...)
{
    const stream_note note = {.level = level};
    char text[LONGEST_NOTE];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    out_begin(o, STREAM_NOTE, sizeof note + strlen(text) + 1);
    out_bytes(o, &note, sizeof note);
    out_bytes(o, text, strlen(text) + 1);
    out_end(o);
}

void out_fail(out *o, stream_reason reason, const char *text)
{
    const stream_error error = {.reason = reason};
    out_begin(o, STREAM_ERROR, sizeof error + strlen(text) + 1);
    out_bytes(o, &error, sizeof error);
    out_bytes(o, text, strlen(text) + 1);
    out_end(o);
    out_finish(o);
}

void out_finish(out *o)
{
    out_struct(o, STREAM_END, NULL, 0);
    out_flush(o);
    _exit(0); /* what others would do at the end needs more than the cage leaves */
}
