/*
 * What the importer can no longer do once it has opened its files: open any other, in
 * any way; make sockets, threads or processes; signal others; run what it has written;
 * have more memory or time than it was given. What it can: compute, write to the pipe,
 * end.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct cage {
    size_t memory;    /**< bytes of address space */
    unsigned seconds; /**< of computing */
} cage;

/** @brief Closes it, for good.
 * @return what is missing of it on this system, static; NULL: nothing */
const char *cage_close(const cage *c);
