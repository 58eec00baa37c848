#include "light/ies.h"

#include "math/vec.h"

#include <string.h>

enum { MAX_ANGLES = 4096, LONGEST_QUOTE = 60 };

/** @brief A type of photometry: what the angles of its files mean. */
typedef struct ies_photometry {
    int number; /**< in the file */
    bool (*check)(const ies_profile *ies, GError **error);
    /** From a direction to angles within those of the file, by its symmetries; false if
     * it is none of its. */
    bool (*locate)(const ies_profile *ies, float gamma, float c, float *v, float *h);
    double (*lumens)(const ies_profile *ies);
} ies_photometry;

static const ies_photometry *find_type(double number);

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
              (int)MIN(strcspn(r->at, "\r\n"), LONGEST_QUOTE), r->at);
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

/* Past the TILT line; a table of factors for tilted lights gives that of an upright one.
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
                  "expected TILT=NONE or TILT=INCLUDE, found '%.*s'",
                  (int)MIN(length, LONGEST_QUOTE), word);
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
    double tilt, multiplier, type, ballast, light;
    if (!read_tilt(r, &tilt) || !skip_numbers(r, 2, "lamps and lumens a lamp") ||
        !next_number(r, "a multiplier", &multiplier) ||
        !next_count(r, "a number of vertical angles", &out->n_vertical) ||
        !next_count(r, "a number of horizontal angles", &out->n_horizontal) ||
        !next_number(r, "a photometric type", &type) ||
        !skip_numbers(r, 4, "units, width, length and height") ||
        !next_number(r, "a ballast factor", &ballast) ||
        !next_number(r, "a ballast-lamp factor", &light) ||
        !skip_numbers(r, 1, "input watts"))
        return false;
    *scale = tilt * multiplier * ballast * light;
    out->type = find_type(type);
    if (out->type)
        return true;
    error_set(r->error, ERROR_INPUT,
              "expected photometry of type 1 (C), 2 (B) or 3 (A), found %g", type);
    return false;
}

/* Room for n numbers, if so many can be in what is left: none is written with fewer than
 * two characters. */
static float *room_for(ies_reader *r, size_t n, const char *what)
{
    size_t left = strlen(r->at);
    if (n <= left / 2 + 1)
        return g_new0(float, n);
    error_set(r->error, ERROR_INPUT,
              "expected %zu numbers from %s on, found %zu characters", n, what, left);
    return NULL;
}

static bool read_angles(ies_reader *r, int n, const char *what, float **out)
{
    *out = room_for(r, (size_t)n, what);
    if (!*out)
        return false;
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

static bool read_values(ies_reader *r, ies_profile *out, double scale)
{
    size_t n = (size_t)out->n_vertical * (size_t)out->n_horizontal;
    out->candela = room_for(r, n, "candela");
    if (!out->candela)
        return false;
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
        out->type->check(out, error) && read_values(&r, out, scale))
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

/* ---- Between angles ---- */

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

static float at(const ies_profile *ies, int i_horizontal, int i_vertical)
{
    return ies
        ->candela[(size_t)i_horizontal * (size_t)ies->n_vertical + (size_t)i_vertical];
}

static double radians(float degrees)
{
    return (double)degrees * G_PI / 180.0;
}

/* ∫ (a + b (x - x0)) sin x dx, by parts. */
static double sine_part(float x0, float x1, double a, double a1)
{
    double g0 = radians(x0), g1 = radians(x1), b = (a1 - a) / (g1 - g0);
    return a * (cos(g0) - cos(g1)) + b * (sin(g1) - sin(g0) - (g1 - g0) * cos(g1));
}

/* The same with cos x, the sine of a right angle more. */
static double cosine_part(float x0, float x1, double a, double a1)
{
    return sine_part(x0 + 90.0f, x1 + 90.0f, a, a1);
}

/* ---- Type C ---- */

static bool check_c(const ies_profile *ies, GError **error)
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

static bool locate_c(const ies_profile *ies, float gamma, float c, float *v, float *h)
{
    *v = gamma;
    *h = fold(ies, c);
    return true;
}

/* ∫ of one half plane over γ, the values linear between. */
static double zone(const ies_profile *ies, int i)
{
    double sum = 0.0;
    for (int j = 0; j + 1 < ies->n_vertical; j++)
        sum += sine_part(ies->vertical[j], ies->vertical[j + 1], (double)at(ies, i, j),
                         (double)at(ies, i, j + 1));
    return sum;
}

static double lumens_c(const ies_profile *ies)
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

/* ---- Types A and B ---- */

static bool is_mirrored(const ies_profile *ies)
{
    return ies->horizontal[0] > -0.5f;
}

/* Both from -90 or 0 to 90 at most; horizontal ones from 0 are mirrored. */
static bool check_ab(const ies_profile *ies, GError **error)
{
    float low = ies->vertical[0], high = ies->vertical[ies->n_vertical - 1];
    float first = ies->horizontal[0], last = ies->horizontal[ies->n_horizontal - 1];
    bool around = fabsf(first) < 0.5f || (first > -90.5f && first < 0.0f);
    if (low > -90.5f && high < 90.5f && around && last < 90.5f && ies->n_vertical > 1 &&
        ies->n_horizontal > 1)
        return true;
    error_set(error, ERROR_INPUT,
              "expected vertical angles in -90..90 and horizontal ones from -90 or 0 to "
              "90, found %g..%g and %g..%g",
              (double)low, (double)high, (double)first, (double)last);
    return false;
}

static bool locate_ab(const ies_profile *ies, float *h)
{
    const float slack = 1e-3f;
    if (is_mirrored(ies))
        *h = fabsf(*h);
    return *h >= ies->horizontal[0] - slack &&
           *h <= ies->horizontal[ies->n_horizontal - 1] + slack;
}

static bool locate_a(const ies_profile *ies, float gamma, float c, float *v, float *h)
{
    *v = gamma - 90.0f;
    *h = 360.0f * floorf(c / 360.0f + 0.5f) - c;
    return locate_ab(ies, h);
}

static bool locate_b(const ies_profile *ies, float gamma, float c, float *v, float *h)
{
    const float degrees = 180.0f / PI_F;
    float down = cosf(gamma / degrees), ahead = sinf(gamma / degrees) * cosf(c / degrees);
    float side = sinf(gamma / degrees) * sinf(c / degrees);
    *v = atan2f(ahead, down) * degrees;
    *h = -asinf(clampf(side, -1.0f, 1.0f)) * degrees;
    return locate_ab(ies, h);
}

/* v is the latitude. */
static double lumens_a(const ies_profile *ies)
{
    double sum = 0.0;
    for (int i = 0; i + 1 < ies->n_horizontal; i++)
        for (int j = 0; j + 1 < ies->n_vertical; j++) {
            double width = radians(ies->horizontal[i + 1] - ies->horizontal[i]);
            double below = 0.5 * (double)(at(ies, i, j) + at(ies, i + 1, j));
            double above = 0.5 * (double)(at(ies, i, j + 1) + at(ies, i + 1, j + 1));
            sum +=
                width * cosine_part(ies->vertical[j], ies->vertical[j + 1], below, above);
        }
    return is_mirrored(ies) ? 2.0 * sum : sum;
}

/* h is the latitude. */
static double lumens_b(const ies_profile *ies)
{
    double sum = 0.0;
    for (int i = 0; i + 1 < ies->n_horizontal; i++)
        for (int j = 0; j + 1 < ies->n_vertical; j++) {
            double width = radians(ies->vertical[j + 1] - ies->vertical[j]);
            double before = 0.5 * (double)(at(ies, i, j) + at(ies, i, j + 1));
            double behind = 0.5 * (double)(at(ies, i + 1, j) + at(ies, i + 1, j + 1));
            sum += width * cosine_part(ies->horizontal[i], ies->horizontal[i + 1], before,
                                       behind);
        }
    return is_mirrored(ies) ? 2.0 * sum : sum;
}

/* ---- Asking ---- */

static const ies_photometry types[] = {
    {1, check_c, locate_c, lumens_c},
    {2, check_ab, locate_b, lumens_b},
    {3, check_ab, locate_a, lumens_a},
};

static const ies_photometry *find_type(double number)
{
    for (size_t i = 0; i < G_N_ELEMENTS(types); i++)
        if (fabs(number - types[i].number) < 0.5)
            return &types[i];
    return NULL;
}

float ies_candela(const ies_profile *ies, float gamma, float c)
{
    const float slack = 1e-3f;
    float s, t, v, h;
    if (!ies->type->locate(ies, gamma, c, &v, &h) || v < ies->vertical[0] - slack ||
        v > ies->vertical[ies->n_vertical - 1] + slack)
        return 0.0f;
    int i = find_angle(ies->horizontal, ies->n_horizontal, h, &s);
    int j = find_angle(ies->vertical, ies->n_vertical, v, &t);
    int k = s > 0.0f ? i + 1 : i;
    return lerpf(lerpf(at(ies, i, j), at(ies, i, j + 1), t),
                 lerpf(at(ies, k, j), at(ies, k, j + 1), t), s);
}

double ies_lumens(const ies_profile *ies)
{
    return ies->type->lumens(ies);
}
