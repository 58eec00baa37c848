/*
 * Numbers in text.
 *
 * The quick path (Clinger, "How to Read Floating Point Numbers Accurately", 1990): up to
 * 19 digits make an integer m; if m <= 2^53 and the power of ten is at most 22, both are
 * exact doubles and one multiplication or division rounds correctly. A float made from
 * that double is correct too, unless the double lies just in the middle of two floats or
 * below the normal range; then, and for longer numbers, the C library reads it.
 */
#define _GNU_SOURCE
#include "format/number.h"

#include <float.h>
#include <glib.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/** m * 10^exponent; exact: all digits are in m. */
typedef struct decimal {
    uint64_t m;
    int exponent;
    bool negative, exact;
} decimal;

enum { MAX_POWER = 22, MAX_DIGITS = 19, LONGEST = 4096 };

static const double powers[MAX_POWER + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/** Digits from p on into d; *n_digits counts significant ones. */
static const char *scan_digits(const char *p, const char *end, decimal *d, int *n_digits,
                               bool fraction)
{
    for (; p < end && *p >= '0' && *p <= '9'; p++) {
        if (*n_digits < MAX_DIGITS) {
            d->m = d->m * 10 + (uint64_t)(*p - '0');
            *n_digits += d->m != 0;
            d->exponent -= fraction;
        } else {
            d->exact &= *p == '0';
            d->exponent += !fraction;
        }
    }
    return p;
}

static const char *scan_exponent(const char *p, const char *end, decimal *d)
{
    bool negative = p < end && *p == '-';
    p += p < end && (*p == '-' || *p == '+');
    if (p == end)
        return NULL;
    int e = 0;
    for (; p < end && *p >= '0' && *p <= '9'; p++)
        e = e < 100000 ? e * 10 + (*p - '0') : e;
    d->exponent += negative ? -e : e;
    return p;
}

static bool scan(const char *p, size_t n, decimal *d)
{
    const char *end = p + n;
    *d = (decimal){.exact = true};
    if (n > LONGEST)
        return false;
    d->negative = p < end && *p == '-';
    p += p < end && (*p == '-' || *p == '+');
    const char *digits = p;
    int n_digits = 0;
    p = scan_digits(p, end, d, &n_digits, false);
    ptrdiff_t n_read = p - digits;
    if (p < end && *p == '.') {
        digits = ++p;
        p = scan_digits(p, end, d, &n_digits, true);
        n_read += p - digits;
    }
    if (n_read == 0)
        return false;
    if (p < end && (*p == 'e' || *p == 'E'))
        p = scan_exponent(p + 1, end, d);
    return p == end;
}

static bool quick(const decimal *d, double *out)
{
    if (!d->exact || d->m > (1ull << DBL_MANT_DIG) || abs(d->exponent) > MAX_POWER)
        return false;
    double m = (double)d->m;
    double x = d->exponent < 0 ? m / powers[-d->exponent] : m * powers[d->exponent];
    *out = d->negative ? -x : x;
    return true;
}

/** True if the float nearest to the rounded double may not be nearest to the number. */
static bool float_is_doubtful(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bool middle = (bits & 0x1fffffff) == 0x10000000;
    return middle || (fabs(x) < (double)FLT_MIN && fabs(x) > 0.0);
}

static locale_t the_c_locale;

static void make_c_locale(void)
{
    the_c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

static locale_t c_locale(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_c_locale);
    return the_c_locale;
}

bool number_double(const char *text, size_t n, double *out)
{
    decimal d;
    if (!scan(text, n, &d))
        return false;
    if (quick(&d, out))
        return true;
    char copy[LONGEST + 1];
    memcpy(copy, text, n);
    copy[n] = '\0';
    *out = strtod_l(copy, NULL, c_locale());
    return isfinite(*out);
}

bool number_float(const char *text, size_t n, float *out)
{
    decimal d;
    double x;
    if (!scan(text, n, &d))
        return false;
    if (quick(&d, &x) && !float_is_doubtful(x)) {
        *out = (float)x;
        return isfinite(*out);
    }
    char copy[LONGEST + 1];
    memcpy(copy, text, n);
    copy[n] = '\0';
    *out = strtof_l(copy, NULL, c_locale());
    return isfinite(*out);
}

bool number_int(const char *text, size_t n, int *out)
{
    const char *p = text, *end = text + n;
    bool negative = p < end && *p == '-';
    p += p < end && (*p == '-' || *p == '+');
    if (p == end)
        return false;
    int64_t value = 0;
    for (; p < end; p++) {
        if (*p < '0' || *p > '9')
            return false;
        value = value * 10 + (*p - '0');
        if (value > (int64_t)INT_MAX + 1)
            return false;
    }
    value = negative ? -value : value;
    *out = (int)value;
    return value <= INT_MAX;
}
