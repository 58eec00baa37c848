/*
 * The library never prints: notes and warnings go to the sink that the program gave.
 */
#pragma once

#include "base/error.h"

typedef enum log_level { LOG_NOTE, LOG_WARNING } log_level;

/** @brief Where messages go; write NULL discards them. Called from the thread that calls
 * us. */
typedef struct log_sink {
    void (*write)(log_level level, const char *text, void *data);
    void *data;
} log_sink;

/** @brief Formats one line (without newline), makes it printable (printable.h) and hands
 * it to the sink, which may be NULL. */
void log_message(const log_sink *sink, log_level level, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/** @brief The same of a place, which the line begins with as an error's does. */
void log_at(const log_sink *sink, log_level level, source_place place, const char *format,
            ...) G_GNUC_PRINTF(4, 5);
