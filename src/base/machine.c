#include "base/machine.h"

#include <glib.h>
#include <stdint.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* The number in a file; SIZE_MAX if it has none, such as "max". */
static size_t read_limit(const char *path)
{
    guint64 value;
    g_autofree char *text = NULL;
    if (!g_file_get_contents(path, &text, NULL, NULL) ||
        !g_ascii_string_to_unsigned(g_strstrip(text), 10, 0, SIZE_MAX, &value, NULL))
        return SIZE_MAX;
    return (size_t)value;
}

/* A group has no more than those that it lies in. In a container the path may lead out of
   what is mounted: then the mount itself is the group. */
static size_t least_up(const char *mount, const char *group, const char *file)
{
    size_t least = SIZE_MAX;
    g_autofree char *at = g_strdup(group);
    for (;;) {
        g_autofree char *path = g_build_filename(mount, at, file, NULL);
        least = MIN(least, read_limit(path));
        char *slash = strrchr(at, '/');
        if (!slash)
            return least;
        *slash = '\0';
    }
}

/* @param controllers of a line: none is version 2 */
static size_t group_memory(const char *mount, const char *controllers, const char *group)
{
    g_auto(GStrv) names = g_strsplit(controllers, ",", -1);
    if (*controllers == '\0')
        return least_up(mount, group, "memory.max");
    if (!g_strv_contains((const char *const *)names, "memory"))
        return SIZE_MAX;
    g_autofree char *folder = g_build_filename(mount, "memory", NULL);
    return least_up(folder, group, "memory.limit_in_bytes");
}

size_t machine_cgroup_memory(const char *mount, const char *groups)
{
    size_t least = SIZE_MAX;
    g_auto(GStrv) lines = g_strsplit(groups, "\n", -1);
    for (char **line = lines; *line; line++) {
        g_auto(GStrv) fields = g_strsplit(*line, ":", 3);
        if (g_strv_length(fields) == 3)
            least = MIN(least, group_memory(mount, fields[1], fields[2]));
    }
    return least;
}

size_t machine_memory(void)
{
    struct rlimit space;
    g_autofree char *groups = NULL;
    size_t least = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE);
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
        least = MIN(least, (size_t)space.rlim_cur);
    if (g_file_get_contents("/proc/self/cgroup", &groups, NULL, NULL))
        least = MIN(least, machine_cgroup_memory("/sys/fs/cgroup", groups));
    return least;
}
