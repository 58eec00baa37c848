/*
 * The kinds of materials: one file and one row each.
 */
#pragma once

#include "material/material.h"

extern const material_kind material_diffuse;
extern const material_kind material_conductor;
extern const material_kind material_dielectric;
extern const material_kind material_thin_dielectric;
extern const material_kind material_coated_diffuse;
extern const material_kind material_coated_conductor;
extern const material_kind material_phong;
extern const material_kind material_gltf;
extern const material_kind material_diffuse_transmission;
extern const material_kind material_mix;
