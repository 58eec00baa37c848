/*
 * Words of scenes with fog, for tests that render them.
 */
#pragma once

#include "rooms.h"

/** A medium of these coefficients at all wavelengths. */
#define FOG(name, a, s, g)                                                               \
    "MakeNamedMedium \"" name "\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" " \
    "[300 " a " 900 " a "] \"spectrum sigma_s\" [300 " s " 900 " s "] \"float g\" " g    \
    "\n"

#define BETWEEN(inside, outside) "MediumInterface \"" inside "\" \"" outside "\"\n"

/** A view from within a medium; what comes next is made of it. */
#define WIDE_EYE(in, look, fov)                                                          \
    BETWEEN("", in)                                                                      \
    "LookAt " look " 0 0 1 Camera \"perspective\" \"float fov\" " fov                    \
    "\n" SIZE(8) "WorldBegin Material \"interface\"\n"

/** A narrow one, all of whose rays are the middle one but for 1/1000. */
#define EYE(in, look) WIDE_EYE(in, look, "1")

/** A box with its normals outward, from -half to half in x and y. */
#define BOX(half, near, far)                                                             \
    "Shape \"trianglemesh\" \"point3 P\" [-" half " -" half " " near " " half " -" half  \
    " " near " " half " " half " " near " -" half " " half " " near " -" half " -" half  \
    " " far " " half " -" half " " far " " half " " half " " far " -" half " " half      \
    " " far "] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 "  \
    "3 7 2 7 6 3 0 4 3 4 7]\n"

#define BALL(radius) "Shape \"sphere\" \"float radius\" " radius "\n"

/** Radiance 1 from everywhere. */
#define SKY "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"

#define POINT(from) "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [" from "]\n"

/** Irradiance 1 across the beam. */
#define DISTANT(from)                                                                    \
    "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [" from "] \"point3 "     \
    "to\" [0 0 0]\n"

#define BLACK "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"

/** Shines 1 and reflects nothing; what follows is its shape. */
#define LAMP(shape)                                                                      \
    "AttributeBegin " BLACK "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] " shape       \
    " AttributeEnd\n"

/** Reflects one half. */
#define GREY(shape)                                                                      \
    "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] " shape          \
    " AttributeEnd\n"
