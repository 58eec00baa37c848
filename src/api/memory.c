#include "base/memory.h"

#include "nephroid/nephroid.h"

#include <math.h>
#include <string.h>

/* The power of 1024 that a letter stands for; -1: none. */
static int unit_power(const char *unit)
{
    static const char letters[] = "KMGT";
    const char *found = *unit ? strchr(letters, g_ascii_toupper(*unit)) : NULL;
    if (*unit == '\0')
        return 0;
    return found && unit[1] == '\0' ? (int)(found - letters) + 1 : -1;
}

/* The bytes that a text says, 0: it says none, or less than one. */
static size_t parse_size(const char *text)
{
    char *unit;
    double number = g_ascii_strtod(text, &unit);
    int power = unit_power(unit);
    bool is_decimal = unit > text && strspn(text, "0123456789.") == (size_t)(unit - text);
    double bytes = is_decimal && power >= 0 ? ldexp(number, 10 * power) : 0.0;
    return bytes >= 1.0 && bytes < 0x1p63 ? (size_t)bytes : 0;
}

bool neph_memory_set_limit(const char *size, GError **error)
{
    size_t bytes = size ? parse_size(size) : 0;
    if (size && bytes == 0) {
        error_set(error, ERROR_USAGE, "memory: expected a size as 2G or 500M, found '%s'",
                  size);
        return false;
    }
    memory_set_limit(bytes);
    return true;
}

size_t neph_memory_limit(void)
{
    return memory_limit();
}
