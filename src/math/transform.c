#include "math/transform.h"

#include <glib.h>
#include <string.h>

transform transform_identity(void)
{
    transform t = {0};
    for (int i = 0; i < 4; i++)
        t.m[i][i] = t.inverse[i][i] = 1.0;
    return t;
}

static void swap_rows(double a[4][8], int i, int j)
{
    double row[8];
    memcpy(row, a[i], sizeof row);
    memcpy(a[i], a[j], sizeof row);
    memcpy(a[j], row, sizeof row);
}

/* Gauss-Jordan elimination with partial pivoting on the matrix augmented by the identity.
 */
static bool invert(const double m[4][4], double inverse[4][4])
{
    double a[4][8] = {0};
    for (int i = 0; i < 4; i++) {
        memcpy(a[i], m[i], 4 * sizeof(double));
        a[i][4 + i] = 1.0;
    }
    for (int column = 0; column < 4; column++) {
        int pivot = column;
        for (int i = column + 1; i < 4; i++) {
            if (fabs(a[i][column]) > fabs(a[pivot][column]))
                pivot = i;
        }
        if (!(fabs(a[pivot][column]) > 0.0) || !isfinite(a[pivot][column]))
            return false;
        swap_rows(a, pivot, column);
        double scale = 1.0 / a[column][column];
        for (int k = 0; k < 8; k++)
            a[column][k] *= scale;
        for (int i = 0; i < 4; i++) {
            double factor = i == column ? 0.0 : a[i][column];
            for (int k = 0; k < 8; k++)
                a[i][k] -= factor * a[column][k];
        }
    }
    for (int i = 0; i < 4; i++)
        memcpy(inverse[i], &a[i][4], 4 * sizeof(double));
    return true;
}

bool transform_from_matrix(const double m[4][4], transform *out)
{
    transform t;
    memcpy(t.m, m, sizeof t.m);
    for (int i = 0; i < 16; i++) {
        if (!isfinite(m[i / 4][i % 4]))
            return false;
    }
    if (!invert(m, t.inverse))
        return false;
    *out = t;
    return true;
}

/* The determinant without a row and a column, with the sign of their place. */
static double cofactor(const double m[4][4], int row, int column)
{
    double a[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            a[i][k] = m[i + (i >= row)][k + (k >= column)];
    double minor = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                   a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                   a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    return (row + column) % 2 ? -minor : minor;
}

/* The adjugate, scaled as an inverse would be. */
static void adjugate(const double m[4][4], double out[4][4])
{
    double most = 0.0, most_out = 0.0;
    for (int i = 0; i < 16; i++) {
        out[i % 4][i / 4] = cofactor(m, i / 4, i % 4);
        most = MAX(most, fabs(m[i / 4][i % 4]));
        most_out = MAX(most_out, fabs(out[i % 4][i / 4]));
    }
    for (int i = 0; i < 16 && most_out > 0.0; i++)
        out[i / 4][i % 4] /= most * most_out;
}

bool transform_from_any_matrix(const double m[4][4], transform *out)
{
    if (transform_from_matrix(m, out))
        return true;
    memcpy(out->m, m, sizeof out->m);
    adjugate(m, out->inverse);
    double sum = 0.0;
    for (int i = 0; i < 16; i++)
        sum += fabs(m[i / 4][i % 4]);
    return isfinite(sum);
}

static void multiply(const double a[4][4], const double b[4][4], double out[4][4])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += a[i][k] * b[k][j];
            out[i][j] = sum;
        }
    }
}

transform transform_multiply(const transform *a, const transform *b)
{
    transform product;
    multiply(a->m, b->m, product.m);
    multiply(b->inverse, a->inverse, product.inverse);
    return product;
}

/* A matrix times its inverse is 1, times its adjugate the determinant, which is 0. */
bool transform_can_invert(const transform *t)
{
    double product[4][4];
    multiply(t->m, t->inverse, product);
    return product[0][0] + product[1][1] + product[2][2] + product[3][3] > 2.0;
}

transform transform_inverse(const transform *t)
{
    transform inverse;
    memcpy(inverse.m, t->inverse, sizeof inverse.m);
    memcpy(inverse.inverse, t->m, sizeof inverse.inverse);
    return inverse;
}

transform transform_translate(double x, double y, double z)
{
    transform t = transform_identity();
    double d[3] = {x, y, z};
    for (int i = 0; i < 3; i++) {
        t.m[i][3] = d[i];
        t.inverse[i][3] = -d[i];
    }
    return t;
}

transform transform_scale(double x, double y, double z)
{
    transform t = transform_identity();
    double d[3] = {x, y, z};
    for (int i = 0; i < 3; i++) {
        t.m[i][i] = d[i];
        t.inverse[i][i] = 1.0 / d[i];
    }
    return t;
}

transform transform_rotate(double degrees, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    double a[3] = {x / length, y / length, z / length};
    double s = sin(degrees * G_PI / 180.0), c = cos(degrees * G_PI / 180.0);
    double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
    transform t = transform_identity();
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double diagonal = i == j ? c : 0.0;
            t.m[i][j] = diagonal + (1.0 - c) * a[i] * a[j] + s * cross[i][j];
            t.inverse[j][i] = t.m[i][j];
        }
    }
    return t;
}

static bool unit(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length > 0.0 && isfinite(length);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

bool transform_look_at(const double eye[3], const double target[3], const double up[3],
                       transform *out)
{
    double forward[3] = {target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]};
    double up_unit[3] = {up[0], up[1], up[2]};
    double right[3], new_up[3];
    if (!unit(forward) || !unit(up_unit))
        return false;
    cross(up_unit, forward, right);
    if (!unit(right))
        return false;
    cross(forward, right, new_up);
    double camera_to_world[4][4] = {{0}};
    for (int i = 0; i < 3; i++) {
        camera_to_world[i][0] = right[i];
        camera_to_world[i][1] = new_up[i];
        camera_to_world[i][2] = forward[i];
        camera_to_world[i][3] = eye[i];
    }
    camera_to_world[3][3] = 1.0;
    transform t;
    if (!transform_from_matrix((const double(*)[4])camera_to_world, &t))
        return false;
    *out = transform_inverse(&t);
    return true;
}

vec3 transform_point(const transform *t, vec3 p)
{
    double out[4];
    for (int i = 0; i < 4; i++) {
        out[i] = t->m[i][0] * (double)p[0] + t->m[i][1] * (double)p[1] +
                 t->m[i][2] * (double)p[2] + t->m[i][3];
    }
    return vec3_make((float)(out[0] / out[3]), (float)(out[1] / out[3]),
                     (float)(out[2] / out[3]));
}

vec3 transform_vector(const transform *t, vec3 v)
{
    vec3 out = {0};
    for (int i = 0; i < 3; i++) {
        out[i] = (float)(t->m[i][0] * (double)v[0] + t->m[i][1] * (double)v[1] +
                         t->m[i][2] * (double)v[2]);
    }
    return out;
}

vec3 transform_normal(const transform *t, vec3 n)
{
    vec3 out = {0};
    for (int i = 0; i < 3; i++) {
        out[i] =
            (float)(t->inverse[0][i] * (double)n[0] + t->inverse[1][i] * (double)n[1] +
                    t->inverse[2][i] * (double)n[2]);
    }
    return out;
}

box3 transform_box(const transform *t, box3 box)
{
    box3 out = box3_empty();
    for (unsigned corner = 0; corner < 8; corner++) {
        vec3 p = vec3_make(corner & 1 ? box.high[0] : box.low[0],
                           corner & 2 ? box.high[1] : box.low[1],
                           corner & 4 ? box.high[2] : box.low[2]);
        out = box3_with_point(out, transform_point(t, p));
    }
    return out;
}

bool transform_swaps_handedness(const transform *t)
{
    const double(*m)[4] = t->m;
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return determinant < 0.0;
}

/* The largest number of its linear part. */
static double largest_factor(const transform *t)
{
    double largest = 0.0;
    for (int i = 0; i < 9; i++)
        largest = fmax(largest, fabs(t->m[i / 3][i % 3]));
    return largest;
}

bool transform_equal(const transform *a, const transform *b)
{
    double scale = fmax(largest_factor(a), largest_factor(b));
    for (int i = 0; i < 16; i++) {
        double x = a->m[i / 4][i % 4], y = b->m[i / 4][i % 4];
        if (fabs(x - y) > 1e-12 * fmax(scale, fmax(fabs(x), fabs(y))))
            return false;
    }
    return true;
}
