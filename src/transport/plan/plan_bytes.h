/*
 * A plan as bytes: what one process has decided, for others of the same program that
 * render the same scene by the same settings, and for files.
 *
 * What follows from the scene alone (who casts caustics) is found anew; where the camera
 * looked and what trials asked is not needed any more. All else is there: passes by a
 * plan that was read are those of the plan that was written, bit for bit.
 */
#pragma once

#include "transport/transport.h"

/** @brief Appends the plan. */
void plan_put(const transport_plan *plan, GByteArray *to);

/** @brief Reads one that plan_put wrote of the same scene.
 * @param plan as transport_plan_of makes it; on failure it may only be cleared
 * @return false: ERROR_INPUT, it is none; or ERROR_FAILED, memory */
bool plan_get(transport_plan *plan, const void *data, size_t size, GError **error);
