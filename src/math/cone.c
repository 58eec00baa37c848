#include "math/cone.h"

#include <float.h>
#include <math.h>

/* The line start + t direction from the apex: along the axis a + t b; the square of its
   length c + 2 t d + t². */
typedef struct line {
    double a, b, c, d;
    double cosine;
} line;

static double dot(vec3 a, vec3 b)
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] +
           (double)a[2] * (double)b[2];
}

static bool is_inside(const line *l, double t)
{
    double along = l->a + t * l->b, square = l->c + t * (2.0 * l->d + t);
    return along >= 0.0 && along * along >= l->cosine * l->cosine * square;
}

/* Where the line crosses the cone or its mirror image, in order. @return how many */
static int crossings(const line *l, double t[2])
{
    double k = l->cosine * l->cosine, a = l->b * l->b - k, b = l->a * l->b - k * l->d,
           c = l->a * l->a - k * l->c, square = b * b - a * c;
    if (!(square > 0.0))
        return 0;
    double q = -(b + copysign(sqrt(square), b));
    t[0] = fmin(q / a, c / q);
    t[1] = fmax(q / a, c / q);
    return 2;
}

line_span cone3_clip(const cone3 *c, vec3 start, vec3 direction, float length)
{
    if (!(c->cosine > 0.0f))
        return (line_span){0.0f, length};
    const vec3 from = start - c->apex;
    const line l = {dot(from, c->axis), dot(direction, c->axis), dot(from, from),
                    dot(from, direction), (double)c->cosine};
    const double last = (double)minf(length, FLT_MAX);
    double t[2], low = 0.0;
    line_span inside = {INFINITY, 0.0f};
    int n = crossings(&l, t);
    for (int i = 0; i <= n; i++) {
        double high = i < n ? fmin(fmax(t[i], low), last) : last;
        if (high > low && is_inside(&l, 0.5 * (low + high))) {
            inside.begin = minf(inside.begin, (float)low);
            inside.end = i < n ? (float)high : length;
        }
        low = high;
    }
    return inside;
}
