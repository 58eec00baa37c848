#include "shape/patch.h"

#include <glib.h>

/* Rays through the seam of two patches must not slip between them: this much is added
   around a patch. */
#define SEAM 1e-9

/* Roots of c u² + b u + a = 0. */
static int solve(double a, double b, double c, double roots[2])
{
    double determinant = b * b - 4.0 * a * c;
    if (!(determinant >= 0.0))
        return 0;
    double q = -0.5 * (b + copysign(sqrt(determinant), b));
    int n = 0;
    if (fabs(q) > 0.0)
        roots[n++] = a / q;
    if (fabs(c) > 0.0)
        roots[n++] = q / c;
    return n;
}

/* Where the ray meets the straight line of the patch at u; false if outside of it. */
static bool meet_line(const patch *s, dvec3 start, double u, dvec3 d, double *t,
                      double *v)
{
    dvec3 line = s->b + u * s->e, from = start + u * s->a;
    dvec3 n = dvec3_cross(d, line);
    double n2 = dvec3_dot(n, n);
    dvec3 m = dvec3_cross(n, from);
    *t = dvec3_dot(m, line) / n2;
    *v = dvec3_dot(m, d) / n2;
    return *v >= -SEAM && *v <= 1.0 + SEAM;
}

bool patch_intersect(const patch *s, dvec3 o, dvec3 d, const double range[2], double *t,
                     double uv[2])
{
    /* The line at u and the ray lie in a plane: ((start + u a) × d) · (b + u e) = 0. */
    dvec3 start = s->p00 - o, start_d = dvec3_cross(start, d), a_d = dvec3_cross(s->a, d);
    double roots[2];
    int n =
        solve(dvec3_dot(start_d, s->b), dvec3_dot(start_d, s->e) + dvec3_dot(a_d, s->b),
              dvec3_dot(a_d, s->e), roots);
    bool found = false;
    *t = range[1];
    for (int i = 0; i < n; i++) {
        double at, v;
        if (!(roots[i] >= -SEAM && roots[i] <= 1.0 + SEAM) ||
            !meet_line(s, start, roots[i], d, &at, &v) || !(at > range[0] && at < *t))
            continue;
        *t = at;
        uv[0] = CLAMP(roots[i], 0.0, 1.0);
        uv[1] = CLAMP(v, 0.0, 1.0);
        found = true;
    }
    return found;
}

double patch_area(const patch *s)
{
    /* Gauss' rule of eight points, each way. */
    static const double x[4] = {0.1834346424956498, 0.5255324099163290,
                                0.7966664774136267, 0.9602898564975363};
    static const double weight[4] = {0.3626837833783620, 0.3137066458778873,
                                     0.2223810344533745, 0.1012285362903763};
    double sum = 0.0;
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 8; k++) {
            double u = 0.5 + (i & 1 ? 0.5 : -0.5) * x[i / 2];
            double v = 0.5 + (k & 1 ? 0.5 : -0.5) * x[k / 2];
            sum +=
                0.25 * weight[i / 2] * weight[k / 2] * dvec3_length(patch_cross(s, u, v));
        }
    }
    return sum;
}

double patch_largest_element(const patch *s)
{
    double largest = 0.0;
    for (int corner = 0; corner < 4; corner++)
        largest = fmax(largest,
                       dvec3_length(patch_cross(s, corner & 1, (double)(corner >> 1))));
    return largest;
}
