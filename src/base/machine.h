/*
 * How much memory there is for this process.
 */
#pragma once

#include <stddef.h>

/** @brief Bytes: the least of what the machine has, and what the process's cgroup
 * (version 1 or 2) and ulimit -v let it have. */
size_t machine_memory(void);

/** @brief What a cgroup lets its processes have, SIZE_MAX if there is no limit.
 * @param mount where cgroups are mounted, /sys/fs/cgroup
 * @param groups the contents of /proc/self/cgroup: lines of number:controllers:path */
size_t machine_cgroup_memory(const char *mount, const char *groups);
