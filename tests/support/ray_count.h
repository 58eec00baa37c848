/*
 * How many rays a test's renders ask Embree for, trials and all: work that is the same on
 * any machine, however busy. To be included by one file of the test, which then stands
 * before the library where queries are linked.
 */
#pragma once

#include "accel/accel_embree.h"

#include <dlfcn.h>
#include <stdatomic.h>

static _Atomic uint64_t rays_asked;

#if RTC_VERSION_MAJOR >= 4
#define RAY_QUERY(name, query_type, arguments_type)                                      \
    void name(RTCScene scene, query_type *query, arguments_type *arguments)              \
    {                                                                                    \
        static void (*_Atomic library)(RTCScene, query_type *, arguments_type *);        \
        if (!library)                                                                    \
            library = (void (*)(RTCScene, query_type *, arguments_type *))(              \
                uintptr_t)dlsym(RTLD_NEXT, #name);                                       \
        atomic_fetch_add_explicit(&rays_asked, 1, memory_order_relaxed);                 \
        library(scene, query, arguments);                                                \
    }
RAY_QUERY(rtcIntersect1, struct RTCRayHit, struct RTCIntersectArguments)
RAY_QUERY(rtcOccluded1, struct RTCRay, struct RTCOccludedArguments)
#else
#define RAY_QUERY(name, query_type)                                                      \
    void name(RTCScene scene, struct RTCIntersectContext *context, query_type *query)    \
    {                                                                                    \
        static void (*_Atomic library)(RTCScene, struct RTCIntersectContext *,           \
                                       query_type *);                                    \
        if (!library)                                                                    \
            library = (void (*)(RTCScene, struct RTCIntersectContext *, query_type *))(  \
                uintptr_t)dlsym(RTLD_NEXT, #name);                                       \
        atomic_fetch_add_explicit(&rays_asked, 1, memory_order_relaxed);                 \
        library(scene, context, query);                                                  \
    }
RAY_QUERY(rtcIntersect1, struct RTCRayHit)
RAY_QUERY(rtcOccluded1, struct RTCRay)
#endif
#undef RAY_QUERY
