/*
 * One of each kind of bsdf, for tests that hold for all of them.
 */
#pragma once

#include "bsdf/bsdf_gltf.h"
#include "bsdf/bsdf_models.h"

/* A bsdf to be tested. */
typedef struct model {
    const char *name;
    void (*make)(bsdf *b);
    double least_albedo; /* what it must send back at least, at 45 degrees */
} model;

static const spectrum RAMP = {0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f};
static const spectrum FLINT = {1.76f, 1.74f, 1.73f, 1.72f, 1.71f, 1.705f, 1.7f, 1.695f};

static spectrum gold_eta(void)
{
    return (spectrum){1.66f, 1.64f, 1.41f, 0.75f, 0.4f, 0.22f, 0.16f, 0.14f};
}

static spectrum gold_k(void)
{
    return (spectrum){1.95f, 1.92f, 1.82f, 2.0f, 2.5f, 2.97f, 3.4f, 3.9f};
}

static void make_diffuse(bsdf *b)
{
    bsdf_make_diffuse(b, RAMP);
}

static coat_layers lacquer(ggx coat, ggx metal)
{
    return (coat_layers){.is_metal = true,
                         .metal_eta = gold_eta(),
                         .metal_k = gold_k(),
                         .eta = 1.5f,
                         .thickness = 0.01f,
                         .coat = coat,
                         .base = metal,
                         .max_depth = 10,
                         .n_walks = 1};
}

static void make_lacquer(bsdf *b, ggx coat, ggx metal)
{
    coat_layers layers = lacquer(coat, metal);
    bsdf_make_layered(b, &layers);
}

/* Particles in the coat, over metal and over a diffuse base. */
static void make_pearl(bsdf *b)
{
    coat_layers layers = lacquer((ggx){0}, ggx_make(0.2f, 0.2f));
    layers.albedo = RAMP;
    layers.thickness = 0.5f;
    layers.g = 0.3f;
    bsdf_make_layered(b, &layers);
}

static void make_milky(bsdf *b)
{
    coat_layers layers = lacquer(ggx_make(0.3f, 0.3f), (ggx){0});
    layers.is_metal = false;
    layers.rho = RAMP;
    layers.albedo = spectrum_fill(0.9f);
    layers.thickness = 1.0f;
    layers.g = -0.4f;
    bsdf_make_layered(b, &layers);
}

static void make_lacquered_mirror(bsdf *b)
{
    make_lacquer(b, (ggx){0}, (ggx){0});
}

static void make_car_paint(bsdf *b)
{
    make_lacquer(b, (ggx){0}, ggx_make(0.4f, 0.25f));
}

static void make_frosted_gold(bsdf *b)
{
    make_lacquer(b, ggx_make(0.2f, 0.2f), ggx_make(0.3f, 0.3f));
}

static void make_leaf(bsdf *b)
{
    bsdf_make_diffuse_transmission(b, 0.5f * RAMP, 0.6f - 0.3f * RAMP);
}

static void make_mirror(bsdf *b)
{
    bsdf_make_conductor(b, gold_eta(), gold_k(), (ggx){0});
}

static void make_satin_gold(bsdf *b)
{
    bsdf_make_conductor(b, gold_eta(), gold_k(), ggx_make(0.1f, 0.1f));
}

static void make_brushed_gold(bsdf *b)
{
    bsdf_make_conductor(b, gold_eta(), gold_k(), ggx_make(0.5f, 0.12f));
}

static void make_matt_gold(bsdf *b)
{
    bsdf_make_conductor(b, gold_eta(), gold_k(), ggx_make(0.8f, 0.8f));
}

static void make_glass(bsdf *b)
{
    bsdf_make_dielectric(b, spectrum_fill(1.5f), false, (ggx){0});
}

static void make_flint(bsdf *b)
{
    bsdf_make_dielectric(b, FLINT, true, (ggx){0});
}

static void make_frosted_glass(bsdf *b)
{
    bsdf_make_dielectric(b, spectrum_fill(1.5f), false, ggx_make(0.15f, 0.15f));
}

static void make_rough_glass(bsdf *b)
{
    bsdf_make_dielectric(b, spectrum_fill(1.5f), false, ggx_make(0.6f, 0.35f));
}

static void make_rough_flint(bsdf *b)
{
    bsdf_make_dielectric(b, FLINT, true, ggx_make(0.2f, 0.2f));
}

static void make_air_bubble(bsdf *b)
{
    bsdf_make_dielectric(b, spectrum_fill(1.0f / 1.33f), false, ggx_make(0.3f, 0.3f));
}

static void make_refractor(bsdf *b)
{
    bsdf_make_refractor(b, FLINT, true);
}

static void make_window(bsdf *b)
{
    bsdf_make_thin_dielectric(b, FLINT);
}

static void make_clear(bsdf *b)
{
    bsdf_make_clear(b);
}

static coat_table *coat_of(float alpha, float thickness)
{
    return coat_table_new(&(coat_range){.alpha_min = alpha,
                                        .alpha_max = alpha,
                                        .eta_min = 1.5f,
                                        .eta_max = 1.76f,
                                        .thickness = thickness});
}

/* Coats that bsdfs of the models borrow; made by zoo_open. */
static coat_table *smooth_coat, *satin_coat, *rough_coat;

static inline void zoo_open(void)
{
    smooth_coat = coat_of(0, 0.01f);
    satin_coat = coat_of(0.1f, 0.01f);
    rough_coat = coat_of(0.5f, 0.01f);
}

static inline void zoo_close(void)
{
    coat_table_free(smooth_coat);
    coat_table_free(satin_coat);
    coat_table_free(rough_coat);
}

static void make_plastic(bsdf *b)
{
    bsdf_make_coated(b, RAMP, spectrum_fill(1.5f), 0.0f, smooth_coat, 5);
}

static void make_satin_plastic(bsdf *b)
{
    bsdf_make_coated(b, RAMP, spectrum_fill(1.5f), 0.1f, satin_coat, 5);
}

static void make_rough_plastic(bsdf *b)
{
    bsdf_make_coated(b, RAMP, FLINT, 0.5f, rough_coat, 5);
}

static void make_brushed_plastic(bsdf *b)
{
    coat_layers layers = lacquer(ggx_make(0.1f, 0.25f), (ggx){0});
    layers.is_metal = false;
    layers.rho = RAMP;
    bsdf_make_layered(b, &layers);
}

static void make_phong(bsdf *b)
{
    bsdf_make_phong(b, RAMP, spectrum_fill(0.3f), 60.0f);
}

static void make_broad_phong(bsdf *b)
{
    bsdf_make_phong(b, spectrum_fill(0.2f), RAMP, 6.0f);
}

static void make_tinted_glass(bsdf *b)
{
    bsdf_make_tinted_dielectric(b, FLINT, true, ggx_make(0.2f, 0.2f), RAMP);
}

static void make_gltf_satin(bsdf *b)
{
    bsdf_make_gltf(b, &(gltf_surface){.f0 = spectrum_fill(0.04f),
                                      .f90 = 1.0f,
                                      .plain_f0 = 0.04f,
                                      .plain_f90 = 1.0f,
                                      .diffuse = RAMP,
                                      .roughness = ggx_make(0.15f, 0.15f)});
}

/* Half metal, with all layers there are. */
static void make_gltf_all(bsdf *b)
{
    bsdf_make_gltf(b, &(gltf_surface){.f0 = 0.5f * RAMP + 0.02f,
                                      .f90 = 1.0f,
                                      .plain_f0 = 0.04f,
                                      .plain_f90 = 1.0f,
                                      .diffuse = 0.2f * RAMP,
                                      .through = 0.3f * RAMP,
                                      .coat = 0.5f,
                                      .roughness = ggx_make(0.4f, 0.4f),
                                      .coat_roughness = ggx_make(0.1f, 0.1f)});
}

/* Brushed aslant, over a leaf, under a coat. */
static void make_gltf_brushed(bsdf *b)
{
    bsdf_make_gltf(b, &(gltf_surface){.f0 = spectrum_fill(0.3f),
                                      .f90 = 1.0f,
                                      .plain_f0 = 0.3f,
                                      .plain_f90 = 1.0f,
                                      .diffuse = 0.4f * RAMP,
                                      .leaf = 0.5f * RAMP,
                                      .coat = 0.3f,
                                      .roughness = ggx_make(0.6f, 0.2f),
                                      .coat_roughness = ggx_make(0.3f, 0.3f),
                                      .turn = 0.7f});
}

static void make_gltf_smooth(bsdf *b)
{
    bsdf_make_gltf(b, &(gltf_surface){.f0 = spectrum_fill(0.04f),
                                      .f90 = 1.0f,
                                      .plain_f0 = 0.04f,
                                      .plain_f90 = 1.0f,
                                      .diffuse = 0.5f * RAMP,
                                      .through = 0.5f * RAMP,
                                      .coat = 1.0f});
}

/* White under white: all light comes back. */
static void make_gltf_white(bsdf *b)
{
    bsdf_make_gltf(b, &(gltf_surface){.f0 = spectrum_fill(0.04f),
                                      .f90 = 1.0f,
                                      .plain_f0 = 0.04f,
                                      .plain_f90 = 1.0f,
                                      .diffuse = spectrum_fill(1.0f),
                                      .roughness = ggx_make(0.3f, 0.3f)});
}

static const model MODELS[] = {
    {"diffuse", make_diffuse, 0.2},
    {"leaf", make_leaf, 0.6},
    {"lacquered mirror", make_lacquered_mirror, 0.3},
    {"car paint", make_car_paint, 0.3},
    {"frosted gold", make_frosted_gold, 0.3},
    {"pearl", make_pearl, 0.3},
    {"milky", make_milky, 0.3},
    {"mirror", make_mirror, 0.3},
    {"satin gold", make_satin_gold, 0.3},
    {"brushed gold", make_brushed_gold, 0.3},
    {"matt gold", make_matt_gold, 0.2},
    {"glass", make_glass, 0.9999},
    {"flint", make_flint, 0.9999},
    {"frosted glass", make_frosted_glass, 0.98},
    {"rough glass", make_rough_glass, 0.9},
    {"rough flint", make_rough_flint, 0.97},
    {"air bubble", make_air_bubble, 0.75},
    {"refractor", make_refractor, 0.9999},
    {"window", make_window, 0.9999},
    {"clear", make_clear, 0.9999},
    {"plastic", make_plastic, 0.15},
    {"satin plastic", make_satin_plastic, 0.15},
    {"rough plastic", make_rough_plastic, 0.15},
    {"brushed plastic", make_brushed_plastic, 0.15},
    {"phong", make_phong, 0.25},
    {"broad phong", make_broad_phong, 0.2},
    {"tinted glass", make_tinted_glass, 0.2},
    {"glTF satin", make_gltf_satin, 0.2},
    {"glTF all layers", make_gltf_all, 0.2},
    {"glTF brushed", make_gltf_brushed, 0.2},
    {"glTF smooth", make_gltf_smooth, 0.15},
    {"glTF white", make_gltf_white, 0.97},
};
