/*
 * Large meshes for benchmarks: a grid of quads laid over a surface.
 */
#pragma once

#include "math/mesh.h"

#include <glib.h>

/** @brief Where a grid's place (x, y), each 0..1, lies. */
typedef void (*bench_surface)(float x, float y, float p[3]);

/** @brief A hilly square of side 1. */
void bench_landscape(float x, float y, float p[3]);
/** @brief A hollow ball of radius 1 with a bumpy wall, seen from within; open at the
 * poles. */
void bench_cave(float x, float y, float p[3]);

/** @brief About n triangles; exits the program where memory is refused. */
mesh bench_mesh_make(size_t n, bench_surface surface);
/** @brief Writes it as PLY; exits the program where that fails. */
void bench_mesh_write(const mesh *m, const char *path);
