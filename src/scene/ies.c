#include "scene/ies.h"

#include "math/vec.h"

#include <string.h>

enum { MAX_ANGLES = 4096 };

/* Numbers being read, separated by white space or commas. */
typedef struct ies_reader {
    const char *at;
    GError **error;
} ies_reader;

static bool next_number(ies_reader *r, const char *what, double *out)
{
    char *end;
    while (g_ascii_isspace(*r->at) || *r->at == ',')
        r->at++;
    *out = g_ascii_strtod(r->at, &end);
    if (end != r->at && isfinite(*out)) {
        r->at = end;
        return true;
    }
    error_set(r->error, ERROR_INPUT, "expected %s, found '%.*s'", what,
              (int)strcspn(r->at, "\r\n"), r->at);
    return false;
}

static bool next_count(ies_reader *r, const char *what, int *out)
{
    double x;
    if (!next_number(r, what, &x))
        return false;
    *out = (int)CLAMP(x, -1.0, (double)MAX_ANGLES + 1.0);
    if (*out >= 1 && *out <= MAX_ANGLES)
        return true;
    error_set(r->error, ERROR_INPUT, "expected %s of 1..%d, found %g", what, MAX_ANGLES,
              x);
    return false;
}

static bool skip_numbers(ies_reader *r, int n, const char *what)
{
    double x;
    for (int i = 0; i < n; i++)
        if (!next_number(r, what, &x))
            return false;
    return true;
}

/* The line that begins with a word; NULL if there is none. */
static const char *find_line(const char *text, const char *word)
{
    size_t length = strlen(word);
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (g_ascii_strncasecmp(line, word, length) == 0)
            return line;
    }
    return NULL;
}

/* Past the TILT line; a table of factors for tilted lamps gives that of an upright one.
 */
static bool read_tilt(ies_reader *r, double *factor)
{
    const char *tilt = find_line(r->at, "TILT=");
    double x;
    *factor = 1.0;
    if (!tilt) {
        error_set(r->error, ERROR_INPUT, "expected a line TILT=, found none");
        return false;
    }
    const char *word = tilt + strlen("TILT=");
    size_t length = strcspn(word, "\r\n");
    r->at = word + length;
    if (g_ascii_strncasecmp(word, "NONE", 4) == 0)
        return true;
    if (g_ascii_strncasecmp(word, "INCLUDE", 7) != 0) {
        error_set(r->error, ERROR_INPUT,
                  "expected TILT=NONE or TILT=INCLUDE, found '%.*s'", (int)length, word);
        return false;
    }
    int n;
    return next_number(r, "a lamp-to-luminaire geometry", &x) &&
           next_count(r, "a number of tilt angles", &n) &&
           skip_numbers(r, n, "a tilt angle") &&
           next_number(r, "a tilt factor", factor) &&
           skip_numbers(r, n - 1, "a tilt factor");
}

/* Counts and factors; *scale is what values are multiplied with. */
static bool read_head(ies_reader *r, ies_profile *out, double *scale)
{
    double tilt, multiplier, type, ballast, lamp;
    if (!read_tilt(r, &tilt) || !skip_numbers(r, 2, "lamps and lumens a lamp") ||
        !next_number(r, "a multiplier", &multiplier) ||
        !next_count(r, "a number of vertical angles", &out->n_vertical) ||
        !next_count(r, "a number of horizontal angles", &out->n_horizontal) ||
        !next_number(r, "a photometric type", &type) ||
        !skip_numbers(r, 4, "units, width, length and height") ||
        !next_number(r, "a ballast factor", &ballast) ||
        !next_number(r, "a ballast-lamp factor", &lamp) ||
        !skip_numbers(r, 1, "input watts"))
        return false;
    *scale = tilt * multiplier * ballast * lamp;
    if (fabs(type - 1.0) < 0.5)
        return true;
    error_set(
        r->error, ERROR_INPUT,
        "expected photometry of type C (1), found type %g: A and B are not supported",
        type);
    return false;
}

static bool read_angles(ies_reader *r, int n, const char *what, float **out)
{
    *out = g_new0(float, (gsize)n);
    for (int i = 0; i < n; i++) {
        double x;
        if (!next_number(r, what, &x))
            return false;
        (*out)[i] = (float)x;
        if (i > 0 && !((*out)[i] > (*out)[i - 1])) {
            error_set(r->error, ERROR_INPUT,
                      "expected ascending angles, found %g after %g", x,
                      (double)(*out)[i - 1]);
            return false;
        }
    }
    return true;
}

static bool check_angles(const ies_profile *ies, GError **error)
{
    float top = ies->vertical[ies->n_vertical - 1], first = ies->horizontal[0];
    float last = ies->horizontal[ies->n_horizontal - 1];
    bool around = ies->n_horizontal == 1 ||
                  (fabsf(first) < 0.5f &&
                   (fabsf(last - 90.0f) < 0.5f || fabsf(last - 180.0f) < 0.5f ||
                    (last > 270.0f && last < 360.5f))) ||
                  (fabsf(first - 90.0f) < 0.5f && fabsf(last - 270.0f) < 0.5f);
    if (ies->vertical[0] > -0.5f && top < 180.5f && around && ies->n_vertical > 1)
        return true;
    error_set(error, ERROR_INPUT,
              "expected vertical angles in 0..180 and horizontal ones to 0, 90, 180 or "
              "360, found %g..%g and %g..%g",
              (double)ies->vertical[0], (double)top, (double)first, (double)last);
    return false;
}

static bool read_values(ies_reader *r, ies_profile *out, double scale)
{
    size_t n = (size_t)out->n_vertical * (size_t)out->n_horizontal;
    out->candela = g_new0(float, n);
    for (size_t i = 0; i < n; i++) {
        double x;
        if (!next_number(r, "candela", &x))
            return false;
        out->candela[i] = maxf(0.0f, (float)(x * scale));
    }
    return true;
}

bool ies_read(ies_profile *out, const char *text, GError **error)
{
    ies_reader r = {text, error};
    double scale;
    *out = (ies_profile){0};
    if (read_head(&r, out, &scale) &&
        read_angles(&r, out->n_vertical, "a vertical angle", &out->vertical) &&
        read_angles(&r, out->n_horizontal, "a horizontal angle", &out->horizontal) &&
        check_angles(out, error) && read_values(&r, out, scale))
        return true;
    ies_clear(out);
    return false;
}

void ies_clear(ies_profile *ies)
{
    g_free(ies->vertical);
    g_free(ies->horizontal);
    g_free(ies->candela);
    *ies = (ies_profile){0};
}

/* ---- Asking ---- */

/* The angle below x, and how far to the next. */
static int find_angle(const float *angles, int n, float x, float *share)
{
    int i = 0;
    *share = 0.0f;
    while (i + 2 < n && angles[i + 1] <= x)
        i++;
    if (n > 1)
        *share = clampf((x - angles[i]) / (angles[i + 1] - angles[i]), 0.0f, 1.0f);
    return i;
}

/* Into the part that the file has, by the symmetry that its last angle tells. */
static float fold(const ies_profile *ies, float c)
{
    float first = ies->horizontal[0], last = ies->horizontal[ies->n_horizontal - 1];
    c -= 360.0f * floorf(c / 360.0f);
    if (ies->n_horizontal == 1 || last > 270.5f)
        return c;
    if (first > 45.0f) /* mirrored at the plane of 90 and 270 */
        return c < 90.0f ? 180.0f - c : c > 270.0f ? 540.0f - c : c;
    if (c > 180.0f)
        c = 360.0f - c;
    return last < 135.0f && c > 90.0f ? 180.0f - c : c;
}

float ies_candela(const ies_profile *ies, float gamma, float c)
{
    const float slack = 1e-3f;
    float s, t;
    if (gamma < ies->vertical[0] - slack ||
        gamma > ies->vertical[ies->n_vertical - 1] + slack)
        return 0.0f;
    int i = find_angle(ies->horizontal, ies->n_horizontal, fold(ies, c), &s);
    int j = find_angle(ies->vertical, ies->n_vertical, gamma, &t);
    const float *near = ies->candela + (size_t)i * (size_t)ies->n_vertical;
    const float *far = s > 0.0f ? near + ies->n_vertical : near;
    return lerpf(lerpf(near[j], near[j + 1], t), lerpf(far[j], far[j + 1], t), s);
}

/* ∫ of one half plane over γ, the values linear between: a cos + b sin by parts. */
static double zone(const ies_profile *ies, int i)
{
    const float *values = ies->candela + (size_t)i * (size_t)ies->n_vertical;
    double sum = 0.0;
    for (int j = 0; j + 1 < ies->n_vertical; j++) {
        double g0 = (double)ies->vertical[j] * G_PI / 180.0;
        double g1 = (double)ies->vertical[j + 1] * G_PI / 180.0;
        double a = (double)values[j], b = ((double)values[j + 1] - a) / (g1 - g0);
        sum += a * (cos(g0) - cos(g1)) + b * (sin(g1) - sin(g0) - (g1 - g0) * cos(g1));
    }
    return sum;
}

double ies_lumens(const ies_profile *ies)
{
    if (ies->n_horizontal == 1)
        return 2.0 * G_PI * zone(ies, 0);
    double sum = 0.0, span = 0.0;
    for (int i = 0; i + 1 < ies->n_horizontal; i++) {
        double width = (double)(ies->horizontal[i + 1] - ies->horizontal[i]);
        sum += width * 0.5 * (zone(ies, i) + zone(ies, i + 1));
        span += width;
    }
    return 2.0 * G_PI * sum / span;
}
