/*
 * Parameters and transforms as pbrt-v4 text that reads back to the same.
 */
#pragma once

#include "math/transform.h"
#include "params/params.h"

/** @brief Appends "Transform [ ... ]" and a line end. */
void pbrt_text_transform(GString *out, const double m[4][4]);
/** @brief Appends a string in quotes. */
void pbrt_text_string(GString *out, const char *text);
/** @brief Appends a parameter, `"type name" [ values ]`; its strings are those given, if
 * not NULL. */
void pbrt_text_param(GString *out, const param *q, char *const *strings);
