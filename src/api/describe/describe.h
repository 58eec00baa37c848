/*
 * What is in a scene, counted once and told twice: as text for people and as JSON.
 */
#pragma once

#include "api/objects.h"

/** @brief How many there are of one kind, and what they amount to. */
typedef struct tally {
    const char *kind; /**< borrowed from the kinds table */
    size_t n;
    size_t n_triangles;  /**< of shapes */
    double area;         /**< of shapes, m² */
    double power;        /**< of lights, W of 683 lm: what "power" in a file names */
    size_t n_shining;    /**< shapes that are lights */
    size_t n_caustic;    /**< materials that cast caustics */
    size_t n_scattering; /**< media */
    bool is_environment; /**< of lights */
} tally;

/** @brief All counts; every array holds tally, in the order of first appearance. */
typedef struct summary {
    GArray *shapes, *lights, *materials, *media;
    GArray *textures;             /**< in the order of their kinds' names */
    GPtrArray *caustic_names;     /**< const char*, of materials that cast caustics */
    GPtrArray *warnings;          /**< char* */
    const scene_sources *sources; /**< borrowed */
    size_t n_float_textures, n_spectrum_textures;
    size_t render_bytes;   /**< about what rendering takes, meshes with it */
    size_t geometry_bytes; /**< of mesh arrays */
    size_t process_bytes;  /**< largest resident size so far */
    float view_angle[2];   /**< of the image's width and height, degrees */
} summary;

/** @brief One value that differs from its default. */
typedef void (*setting_visitor)(const setting_row *row, const char *value, void *data);
/** @brief Calls visit for each setting of the scene that differs from its default. */
void visit_changed_settings(const settings *s, setting_visitor visit, void *data);

/** @brief What is allowed, but seldom meant: char*, owned by the array. */
GPtrArray *describe_warnings(const view *v);

/** @brief Both own their result. */
char *describe_as_json(const view *v, const summary *all);
char *describe_as_text(const view *v, const summary *all);
