#include "math/motion.h"

#include <string.h>

/* Samples of a path between which it is taken as straight, with a margin. */
enum { BOUND_STEPS = 32, POLAR_STEPS = 100 };

typedef double matrix3[3][3];

/* ---- Taking a matrix apart ---- */

static double determinant(const matrix3 m)
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* The inverse transpose: cofactors over the determinant. */
static void inverse_transpose(const matrix3 m, matrix3 out)
{
    double d = determinant(m);
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3;
        for (int k = 0; k < 3; k++) {
            int c = (k + 1) % 3, e = (k + 2) % 3;
            out[i][k] = (m[a][c] * m[b][e] - m[a][e] * m[b][c]) / d;
        }
    }
}

/* The nearest rotation, by averaging with the inverse transpose until they agree. Mirrors
   are left to the rest. */
static void rotation_of(const matrix3 m, matrix3 r)
{
    memcpy(r, m, sizeof(matrix3));
    double change = 1.0;
    for (int step = 0; step < POLAR_STEPS && change > 1e-14; step++) {
        matrix3 other;
        inverse_transpose((const double(*)[3])r, other);
        change = 0.0;
        for (int i = 0; i < 9; i++) {
            double mean = 0.5 * (r[i / 3][i % 3] + other[i / 3][i % 3]);
            change = fmax(change, fabs(mean - r[i / 3][i % 3]));
            r[i / 3][i % 3] = mean;
        }
    }
    double sign = determinant((const double(*)[3])r) < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < 9; i++)
        r[i / 3][i % 3] *= sign;
}

/* Shepperd's method: by the largest of the four components. */
static void quaternion_of(const matrix3 r, double q[4])
{
    double trace = r[0][0] + r[1][1] + r[2][2];
    int i = 3;
    double largest = trace;
    for (int k = 0; k < 3; k++) {
        if (r[k][k] > largest) {
            largest = r[k][k];
            i = k;
        }
    }
    if (i == 3) {
        q[3] = 0.5 * sqrt(1.0 + trace);
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            q[k] = (r[b][a] - r[a][b]) / (4.0 * q[3]);
        }
        return;
    }
    int a = (i + 1) % 3, b = (i + 2) % 3;
    q[i] = 0.5 * sqrt(1.0 + r[i][i] - r[a][a] - r[b][b]);
    q[a] = (r[i][a] + r[a][i]) / (4.0 * q[i]);
    q[b] = (r[i][b] + r[b][i]) / (4.0 * q[i]);
    q[3] = (r[b][a] - r[a][b]) / (4.0 * q[i]);
}

static motion_pose take_apart(const transform *t)
{
    motion_pose pose;
    matrix3 m, r;
    for (int i = 0; i < 3; i++) {
        pose.translation[i] = t->m[i][3];
        for (int k = 0; k < 3; k++)
            m[i][k] = t->m[i][k];
    }
    rotation_of((const double(*)[3])m, r);
    quaternion_of((const double(*)[3])r, pose.rotation);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            pose.rest[i][k] = r[0][i] * m[0][k] + r[1][i] * m[1][k] + r[2][i] * m[2][k];
        }
    }
    return pose;
}

/* ---- Putting it together ---- */

static void rotation_from(const double q[4], matrix3 r)
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const matrix3 made = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
        {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
        {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    memcpy(r, made, sizeof made);
}

static void turn(const motion *m, double x, double q[4])
{
    double angle = m->half_angle, s = sin(angle), length = 0.0;
    double a = s > 1e-8 ? sin((1.0 - x) * angle) / s : 1.0 - x;
    double b = s > 1e-8 ? sin(x * angle) / s : x;
    for (int i = 0; i < 4; i++) {
        q[i] = a * m->pose[0].rotation[i] + b * m->pose[1].rotation[i];
        length += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(length);
}

/* The pose at x in 0..1. */
static transform pose_at(const motion *m, double x)
{
    double q[4], all[4][4] = {{0}};
    matrix3 r;
    turn(m, x, q);
    rotation_from(q, r);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            for (int j = 0; j < 3; j++) {
                double rest =
                    (1.0 - x) * m->pose[0].rest[j][k] + x * m->pose[1].rest[j][k];
                all[i][k] += r[i][j] * rest;
            }
        }
        all[i][3] = (1.0 - x) * m->pose[0].translation[i] + x * m->pose[1].translation[i];
    }
    all[3][3] = 1.0;
    transform out;
    return transform_from_matrix((const double(*)[4])all, &out) ? out : m->start;
}

motion motion_still(const transform *at)
{
    return (motion){.start = *at, .end = *at};
}

motion motion_make(const transform *start, const transform *end, double start_time,
                   double end_time)
{
    motion m = motion_still(start);
    if (transform_equal(start, end) || !(end_time > start_time))
        return m;
    m.end = *end;
    m.start_time = start_time;
    m.end_time = end_time;
    m.moves = true;
    m.pose[0] = take_apart(start);
    m.pose[1] = take_apart(end);
    double cosine = 0.0;
    for (int i = 0; i < 4; i++)
        cosine += m.pose[0].rotation[i] * m.pose[1].rotation[i];
    for (int i = 0; i < 4 && cosine < 0.0; i++) /* the shorter way round */
        m.pose[1].rotation[i] = -m.pose[1].rotation[i];
    m.half_angle = acos(fmin(fabs(cosine), 1.0));
    return m;
}

/* 0 at the start, 1 at the end. */
static double share_of(const motion *m, double time)
{
    double x = (time - m->start_time) / (m->end_time - m->start_time);
    return fmin(fmax(x, 0.0), 1.0);
}

transform motion_at(const motion *m, double time)
{
    double x = m->moves ? share_of(m, time) : 0.0;
    if (!(x > 0.0))
        return m->start;
    return x < 1.0 ? pose_at(m, x) : m->end;
}

/* Largest |M p| of the corners of a box. */
static double reach(const double m[3][3], box3 box)
{
    double largest = 0.0;
    for (unsigned corner = 0; corner < 8; corner++) {
        double sum = 0.0;
        for (int i = 0; i < 3; i++) {
            double v = 0.0;
            for (int k = 0; k < 3; k++)
                v += m[i][k] * (double)((corner >> k) & 1 ? box.high[k] : box.low[k]);
            sum += v * v;
        }
        largest = fmax(largest, sqrt(sum));
    }
    return largest;
}

/* How far a path strays from straight between two samples `step` apart: an eighth of
   step² times its second derivative, |R'' S p| + 2 |R' S' p|. */
static double stray(const motion *m, box3 box, double step)
{
    double angle = 2.0 * m->half_angle;
    matrix3 change;
    for (int i = 0; i < 9; i++)
        change[i / 3][i % 3] =
            m->pose[1].rest[i / 3][i % 3] - m->pose[0].rest[i / 3][i % 3];
    double bend =
        angle * angle * fmax(reach(m->pose[0].rest, box), reach(m->pose[1].rest, box)) +
        2.0 * angle * reach((const double(*)[3])change, box);
    return bend * step * step / 8.0;
}

box3 motion_bounds(const motion *m, box3 box, double begin, double end)
{
    if (!m->moves)
        return transform_box(&m->start, box);
    double low = share_of(m, begin), high = share_of(m, end);
    box3 all = box3_empty();
    for (int i = 0; i <= BOUND_STEPS; i++) {
        transform t = pose_at(m, low + (high - low) * i / BOUND_STEPS);
        all = box3_union(all, transform_box(&t, box));
    }
    float margin = (float)(1.001 * stray(m, box, (high - low) / BOUND_STEPS));
    vec3 around = vec3_make(margin, margin, margin);
    return (box3){all.low - around, all.high + around};
}
