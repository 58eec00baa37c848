/*
 * Embree's device: what builds and holds acceleration structures. Their memory counts as
 * ours does (base/memory.h), and what it complains of while it builds is kept.
 */
#pragma once

#include "accel/accel_embree.h"

#include <stdatomic.h>

/** @brief Stays where it is while it is open, since Embree calls it back. */
typedef struct embree_device {
    RTCDevice device;
    const char *what;        /**< is built; static */
    atomic_bool has_refused; /**< memory; then why says so */
    GError *why;
    _Atomic enum RTCError code; /**< the first complaint */
    char message[256];
} embree_device;

/** @param what will be built, for messages; static
 * @param threads 0: one per processor
 * @return false with ERROR_FAILED */
bool embree_device_open(embree_device *d, const char *what, unsigned threads,
                        GError **error);
/** @brief Builds it, also on Embree's own threads. */
void embree_commit(RTCScene scene);
/** @brief Asked when all is built. @return false with ERROR_FAILED if it complained */
bool embree_device_check(embree_device *d, GError **error);
/** @brief After its scenes; also of a device that did not open. */
void embree_device_close(embree_device *d);
