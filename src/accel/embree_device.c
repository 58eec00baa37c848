#include "accel/embree_device.h"

#include "accel/embree_threads.h"
#include "base/memory.h"

char embree_threads;

static void note_error(void *data, enum RTCError code, const char *message)
{
    embree_device *d = data;
    enum RTCError none = RTC_ERROR_NONE;
    embree_take_over();
    if (atomic_compare_exchange_strong(&d->code, &none, code))
        g_strlcpy(d->message, message ? message : "no reason given", sizeof d->message);
    embree_hand_over();
}

/* The first refusal is kept: what is asked for after it fails for the same reason. */
static bool reserve(embree_device *d, size_t bytes)
{
    g_autoptr(GError) why = NULL;
    if (memory_reserve(bytes, d->what, &why))
        return true;
    if (!atomic_exchange(&d->has_refused, true))
        d->why = g_steal_pointer(&why);
    return false;
}

/* Before memory is allocated, when it can still be refused, and after. */
static bool count(embree_device *d, ssize_t bytes, bool after)
{
    if (bytes <= 0)
        memory_release((size_t)-bytes);
    else if (after)
        memory_count((size_t)bytes);
    else
        return reserve(d, (size_t)bytes);
    return true;
}

static bool count_memory(void *data, ssize_t bytes, bool after)
{
    embree_take_over();
    bool may = count(data, bytes, after);
    embree_hand_over();
    return may;
}

bool embree_device_open(embree_device *d, const char *what, unsigned threads,
                        GError **error)
{
    g_autofree char *config = g_strdup_printf("threads=%u,set_affinity=0", threads);
    d->what = what;
    d->device = rtcNewDevice(config);
    if (!d->device) {
        error_set(error, ERROR_FAILED, "Embree does not start (error %d)",
                  (int)rtcGetDeviceError(NULL));
        return false;
    }
    rtcSetDeviceErrorFunction(d->device, note_error, d);
    rtcSetDeviceMemoryMonitorFunction(d->device, count_memory, d);
    return true;
}

void embree_commit(RTCScene scene)
{
    embree_hand_over();
    rtcCommitScene(scene);
    embree_take_over();
}

bool embree_device_check(embree_device *d, GError **error)
{
    if (atomic_load(&d->code) == RTC_ERROR_NONE)
        return true;
    if (d->why)
        g_propagate_error(error, g_steal_pointer(&d->why));
    else
        error_set(error, ERROR_FAILED, "Embree can not build %s: %s", d->what,
                  d->message);
    return false;
}

void embree_device_close(embree_device *d)
{
    if (d->device)
        rtcReleaseDevice(d->device);
    g_clear_error(&d->why);
}
