/*
 * Small scenes that several algorithms render: a furnace, and a room with, by turns,
 * something in it.
 */
#pragma once

#include "render_with.h"

#define SIZE(n)                                                                          \
    "Film \"rgb\" \"integer xresolution\" " #n " \"integer yresolution\" " #n            \
    "\nPixelFilter \"box\"\n"

#define ROOM_CAMERA                                                                      \
    "LookAt 0 -3.4 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 55\n"

/** The walls of a room of 4 x 6 x 2 m. */
#define ROOM_WALLS                                                                       \
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                           \
    "Shape \"trianglemesh\" \"point3 P\" [-2 -4 0 2 -4 0 2 2 0 -2 2 0 -2 -4 2 2 -4 2 "   \
    "2 2 2 -2 2 2] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 "  \
    "7 "                                                                                 \
    "0 3 7 0 7 4 1 5 6 1 6 2]\n"

/** A lamp beneath its ceiling; parameters come between. */
#define ROOM_LAMP(parameters)                                                            \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 7 6] " parameters           \
    " Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"trianglemesh\" "          \
    "\"point3 P\" [-0.7 -0.7 1.98 -0.7 0.7 1.98 0.7 0.7 1.98 0.7 -0.7 1.98] "            \
    "\"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"

#define GLASS_BALL                                                                       \
    "Material \"dielectric\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n"

/* A closed box that shines Le = 1 and reflects 0.5 everywhere: radiance is 2 in every
   place and direction. The camera stands in the middle and sees the middle of a wall. */
#define FURNACE                                                                          \
    "Camera \"perspective\" \"float fov\" 40\n" SIZE(                                    \
        8) "WorldBegin\n"                                                                \
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"                    \
           "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n"      \
           "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 " \
           "1 1 -1 1 1 1 1 "                                                             \
           "-1 1 1] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 " \
           "7 0 3 7 0 7 4 1 "                                                            \
           "5 6 1 6 2]\n"

/* The room with its lamp; something is put into it. */
#define ROOM ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS

typedef struct furnishing {
    const char *name, *text;
    double tolerance; /* of means; the noise of so few samples is half of it */
} furnishing;

static const furnishing furnishings[] = {
    {"empty", "", 0.008},
    {"mirror",
     "Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "
     "\"metal-Ag-k\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.01},
    {"glass",
     "Material \"dielectric\" Translate 0 0 0.6 Shape \"sphere\" \"float radius\" "
     "0.5\n",
     0.01},
    {"dispersive",
     "Material \"dielectric\" \"spectrum eta\" \"glass-N-SF11\" Translate 0 0 0.6 "
     "Shape \"sphere\" \"float radius\" 0.5\n",
     0.012},
    {"rough-metal",
     "Material \"conductor\" \"float roughness\" 0.15 \"bool remaproughness\" "
     "false Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.02},
    {"very-rough-metal",
     "Material \"conductor\" \"float roughness\" 0.5 \"bool "
     "remaproughness\" false Translate 0 0 0.6 Shape \"sphere\" \"float "
     "radius\" 0.5\n",
     0.02},
    {"rough-glass",
     "Material \"dielectric\" \"float roughness\" 0.4 \"bool remaproughness\" "
     "false Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n",
     0.02},
    {"plastic",
     "Material \"coateddiffuse\" \"rgb reflectance\" [0.2 0.4 0.8] Translate 0 0 0.6 "
     "Shape \"sphere\" \"float radius\" 0.5\n",
     0.01},
    {"point-light",
     "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [1 -2 1.5] Material "
     "\"conductor\" \"float roughness\" 0.1 Translate 0 0 0.6 Shape \"sphere\" "
     "\"float radius\" 0.5\n",
     0.02},
};
