/*
 * Statistics on their way from the render to the caller.
 */
#pragma once

#include "nephroid/nephroid.h"
#include "render/render.h"

NephStatistics statistics_export(const render_statistics *from);
