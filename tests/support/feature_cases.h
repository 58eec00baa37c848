/*
 * For test_features: one case at least for each parameter in the features table. Single
 * quotes stand for double ones.
 *
 *   given                   compared with
 *   'type name' value       without it
 *   more || 'type name' ..  `more` alone
 *   a ## 'type name' ..     a in its place, where it can not be left out
 */
#pragma once

#include <stddef.h>

typedef struct feature_case {
    const char *directive, *kind, *given;
} feature_case;

#define SMALL "'integer xresolution' 12 'integer yresolution' 12 "
#define FILM(kind, extension)                                                            \
    {"Film", kind, "'integer yresolution' 4 || 'integer xresolution' 12"},               \
        {"Film", kind, "'integer xresolution' 4 || 'integer yresolution' 12"},           \
        {"Film", kind, SMALL "|| 'float cropwindow' [0 0.5 0 1]"},                       \
        {"Film", kind, SMALL "|| 'integer pixelbounds' [0 6 0 12]"},                     \
        {"Film", kind, SMALL "|| 'string filename' 'a" extension "'"},                   \
        {"Film", kind, SMALL "|| 'float iso' 200"},                                      \
        {"Film", kind, SMALL "|| 'float whitebalance' 5000"},                            \
        {"Film", kind, SMALL "|| 'float maxcomponentvalue' 0.05"},                       \
        {"Film", kind, SMALL "|| 'string sensor' 'nikon_d850'"},                         \
        {"Film", kind, SMALL "|| 'float diagonal' 20"},                                  \
    {                                                                                    \
        "Film", kind, SMALL "|| 'bool savefp16' true"                                    \
    }

#define LENS(kind)                                                                       \
    {"Camera", kind, "'float screenwindow' [-0.5 0.5 -0.5 0.5]"},                        \
        {"Camera", kind, "'float frameaspectratio' 2"},                                  \
        {"Camera", kind, "'float lensradius' 0.3"},                                      \
    {                                                                                    \
        "Camera", kind, "'float lensradius' 0.3 || 'float focaldistance' 2"              \
    }
#define SHUTTER(kind)                                                                    \
    {"Camera", kind, "'float shutteropen' 0.5"},                                         \
    {                                                                                    \
        "Camera", kind, "'float shutterclose' 0.5"                                       \
    }

#define RADII(kind)                                                                      \
    {"PixelFilter", kind, "'float xradius' 0.9"},                                        \
    {                                                                                    \
        "PixelFilter", kind, "'float yradius' 0.9"                                       \
    }

#define POINTS(kind)                                                                     \
    {"Sampler", kind, "'integer pixelsamples' 9"},                                       \
    {                                                                                    \
        "Sampler", kind, "'integer pixelsamples' 4 || 'integer seed' 5"                  \
    }
#define SCRAMBLED(kind)                                                                  \
    {                                                                                    \
        "Sampler", kind, "'string randomization' 'fastowen'"                             \
    }

#define DEPTH(kind)                                                                      \
    {                                                                                    \
        "Integrator", kind, "'integer maxdepth' 7"                                       \
    }

/* What all shapes have; `p`: what the shape can not do without. */
#define SEEN(kind, p)                                                                    \
    {"Shape", kind, p "'float alpha' 0.5"},                                              \
        {"Shape", kind, p "'texture alpha' 'dotted'"},                                   \
    {                                                                                    \
        "Shape", kind, p "'bool camera_visible' false"                                   \
    }
#define QUAD "'point3 P' [-1 -1 0 1 -1 0 -1 1 0 1 1 0] "
#define BENT "'point3 P' [-1 -1 0 1 -1 1 -1 1 0 1 1 0] "
#define TILTED "'normal N' [0.6 0 0.8 0.6 0 0.8 0.6 0 0.8 0.6 0 0.8]"
#define FACES "'integer indices' [0 1 2 2 1 3] "
#define TETRA "'point3 P' [-1 -1 -1 1 -1 1 -1 1 1 1 1 -1] "
#define SIDES "'integer indices' [0 1 2 0 2 3 0 3 1 1 3 2] "
#define CURVE                                                                            \
    "'point3 P' [-1 0 0 -0.7 1 0 -0.5 -1 0 0 0 0 0.3 1 0 0.6 -1 0 1 0 0.5] 'float "      \
    "width' 0.3 "
#define CURVE_OF(more)                                                                   \
    "'point3 P' [-1 0 0 -0.7 1 0 -0.5 -1 0 0 0 0 0.3 1 0 0.6 -1 0 1 0 0.5] " more

#define LIT(kind, base)                                                                  \
    {"LightSource", kind, base "'float scale' 2"},                                       \
    {                                                                                    \
        "LightSource", kind, base "'string group' 'key'"                                 \
    }

#define BUMPY(kind)                                                                      \
    {"Material", kind, "'string normalmap' 'normals.pfm'"},                              \
        {"Material", kind, "'string normalmap' 'normals.pfm' || 'float normalscale' 3"}, \
    {                                                                                    \
        "Material", kind, "'texture displacement' 'waves'"                               \
    }
#define ROUGH(kind, prefix)                                                              \
    {"Material", kind, "'float " prefix "roughness' 0.3"},                               \
        {"Material", kind, "'texture " prefix "roughness' 'dotted'"},                    \
        {"Material", kind, "'float " prefix "uroughness' 0.3"},                          \
        {"Material", kind, "'float " prefix "vroughness' 0.3"},                          \
    {                                                                                    \
        "Material", kind,                                                                \
            "'float " prefix "roughness' 0.3 || 'bool remaproughness' false"             \
    }
#define MILKY "'float thickness' 0.5 'rgb albedo' [0.9 0.7 0.5] || "
#define COAT(kind)                                                                       \
    {"Material", kind, "'float thickness' 0.5"},                                         \
        {"Material", kind, "'texture thickness' 'dotted'"},                              \
        {"Material", kind, "'float thickness' 0.5 || 'rgb albedo' [0.9 0.9 0.9]"},       \
        {"Material", kind, "'float thickness' 0.5 || 'texture albedo' 'check'"},         \
        {"Material", kind, MILKY "'float g' 0.8"},                                       \
        {"Material", kind, MILKY "'texture g' 'dotted'"},                                \
        {"Material", kind, MILKY "'integer maxdepth' 1"},                                \
    {                                                                                    \
        "Material", kind, MILKY "'integer nsamples' 3"                                   \
    }

/* `base`: what the texture can not do without; `scaled`: what makes its pattern show. */
#define MAPPED(kind, base, scaled)                                                       \
    {"Texture", kind, base scaled "## 'string mapping' 'spherical' " base},              \
        {"Texture", kind, base scaled "## 'string mapping' 'cylindrical' " base},        \
        {"Texture", kind, base scaled "## 'string mapping' 'planar' " base},             \
        {"Texture", kind, base "|| 'float uscale' 8"},                                   \
        {"Texture", kind, base "|| 'float vscale' 8"},                                   \
        {"Texture", kind, base scaled "|| 'float udelta' 0.3"},                          \
    {                                                                                    \
        "Texture", kind, base scaled "|| 'float vdelta' 0.3"                             \
    }
#define SCALED "'float uscale' 8 'float vscale' 8 "
#define PLANAR(kind, base)                                                               \
    {"Texture", kind, base "'string mapping' 'planar' || 'vector3 v1' [0.3 1 1]"},       \
    {                                                                                    \
        "Texture", kind, base "'string mapping' 'planar' || 'vector3 v2' [0.3 1 1]"      \
    }
#define PICTURE_MAP "'string filename' 'map.png' "

static const feature_case feature_cases[] = {
    {"Option", "seed", "'integer seed' 7"},
    {"Option", "displacementedgescale", "'float displacementedgescale' 2"},
    {"Option", "gpu", "'bool gpu' true"},
    {"Option", "pixelstats", "'bool pixelstats' true"},
    {"Option", "rendercoordsys", "'string rendercoordsys' 'camera'"},
    {"Option", "wavefront", "'bool wavefront' true"},
    {"Option", "msereferenceimage", "'string msereferenceimage' 'a.exr'"},
    {"Option", "msereferenceout", "'string msereferenceout' 'a.txt'"},
    {"Option", "disablepixeljitter", "'bool disablepixeljitter' true"},
    {"Option", "disabletexturefiltering", "'bool disabletexturefiltering' true"},
    {"Option", "disablewavelengthjitter", "'bool disablewavelengthjitter' true"},
    {"Camera", "perspective", "'float fov' 50"},
    {"Camera", "perspective", "'float halffov' 20"},
    LENS("perspective"),
    SHUTTER("perspective"),
    LENS("orthographic"),
    SHUTTER("orthographic"),
    {"Camera", "spherical", "'string mapping' 'equirectangular'"},
    SHUTTER("spherical"),
    FILM("rgb", ".png"),
    FILM("gbuffer", ".exr"),
    {"Film", "gbuffer", SMALL "|| 'string coordinatesystem' 'world'"},
    FILM("spectral", ".exr"),
    {"Film", "spectral", SMALL "|| 'integer nbuckets' 9"},
    {"Film", "spectral", SMALL "|| 'float lambdamin' 400"},
    {"Film", "spectral", SMALL "|| 'float lambdamax' 700"},
    RADII("box"),
    RADII("gaussian"),
    {"PixelFilter", "gaussian", "'float sigma' 0.3"},
    RADII("mitchell"),
    {"PixelFilter", "mitchell", "'float B' 0.5"},
    {"PixelFilter", "mitchell", "'float C' 0.5"},
    RADII("sinc"),
    {"PixelFilter", "sinc", "'float tau' 2"},
    RADII("triangle"),
    POINTS("halton"),
    SCRAMBLED("halton"),
    POINTS("independent"),
    POINTS("paddedsobol"),
    SCRAMBLED("paddedsobol"),
    POINTS("pmj02bn"),
    POINTS("sobol"),
    SCRAMBLED("sobol"),
    {"Sampler", "stratified", "'integer xsamples' 7"},
    {"Sampler", "stratified", "'integer ysamples' 7"},
    {"Sampler", "stratified", "'integer seed' 5"},
    {"Sampler", "stratified", "'bool jitter' false"},
    POINTS("zsobol"),
    SCRAMBLED("zsobol"),
    DEPTH("bdpt"),
    {"Integrator", "bdpt", "'bool regularize' true"},
    {"Integrator", "bdpt", "'string lightsampler' 'uniform'"},
    {"Integrator", "bdpt", "'bool visualizestrategies' true"},
    {"Integrator", "bdpt", "'bool visualizeweights' true"},
    DEPTH("lightpath"),
    DEPTH("mlt"),
    {"Integrator", "mlt", "'bool regularize' true"},
    {"Integrator", "mlt", "'integer bootstrapsamples' 10"},
    {"Integrator", "mlt", "'integer chains' 10"},
    {"Integrator", "mlt", "'integer mutationsperpixel' 10"},
    {"Integrator", "mlt", "'float largestepprobability' 0.4"},
    {"Integrator", "mlt", "'float sigma' 0.02"},
    DEPTH("path"),
    {"Integrator", "path", "'bool regularize' true"},
    {"Integrator", "path", "'string lightsampler' 'power'"},
    DEPTH("randomwalk"),
    DEPTH("simplepath"),
    {"Integrator", "simplepath", "'bool samplebsdf' false"},
    {"Integrator", "simplepath", "'bool samplelights' false"},
    DEPTH("simplevolpath"),
    DEPTH("sppm"),
    {"Integrator", "sppm", "'integer photonsperiteration' 1000"},
    {"Integrator", "sppm", "'float radius' 0.1"},
    {"Integrator", "sppm", "'integer iterations' 7"},
    {"Integrator", "sppm", "'integer seed' 3"},
    DEPTH("volpath"),
    {"Integrator", "volpath", "'bool regularize' true"},
    {"Integrator", "volpath", "'string lightsampler' 'power'"},
    {"Accelerator", "bvh", "'integer maxnodeprims' 2"},
    {"Accelerator", "bvh", "'string splitmethod' 'middle'"},
    {"Accelerator", "kdtree", "'float emptybonus' 0.1"},
    {"Accelerator", "kdtree", "'integer intersectcost' 10"},
    {"Accelerator", "kdtree", "'integer maxdepth' 3"},
    {"Accelerator", "kdtree", "'integer maxprims' 2"},
    {"Accelerator", "kdtree", "'integer traversalcost' 2"},
    {"Shape", "bilinearmesh", QUAD "## " BENT},
    {"Shape", "bilinearmesh", QUAD "|| " TILTED},
    {"Shape", "bilinearmesh", QUAD "|| 'point2 uv' [0 0 3 0 0 3 3 3]"},
    {"Shape", "bilinearmesh",
     BENT "'integer indices' [0 1 2 3] ## 'integer indices' [1 0 3 2] " BENT},
    {"Shape", "bilinearmesh", QUAD "|| 'integer faceIndices' [1]"},
    {"Shape", "bilinearmesh", QUAD "|| 'string emissionfilename' 'map.png'"},
    SEEN("bilinearmesh", QUAD "|| "),
    {"Shape", "curve", CURVE "## " CURVE_OF("'float width' 0.5")},
    {"Shape", "curve", CURVE "|| 'string type' 'cylinder'"},
    {"Shape", "curve", CURVE "|| 'string basis' 'bspline'"},
    {"Shape", "curve", CURVE "|| 'integer degree' 2"},
    {"Shape", "curve", CURVE_OF("|| 'float width' 0.3")},
    {"Shape", "curve", CURVE_OF("|| 'float width0' 0.3")},
    {"Shape", "curve", CURVE_OF("|| 'float width1' 0.3")},
    {"Shape", "curve",
     CURVE "'string type' 'ribbon' 'normal N' [0 0 1 0 0 1 0 0 1] ## 'normal N' [0 1 1 0 "
           "0 1 0 1 0] 'string type' 'ribbon' " CURVE},
    {"Shape", "curve", CURVE "|| 'integer splitdepth' 5"},
    SEEN("curve", CURVE "|| "),
    {"Shape", "cylinder", "'float radius' 0.5"},
    {"Shape", "cylinder", "'float zmin' -0.3"},
    {"Shape", "cylinder", "'float zmax' 0.3"},
    {"Shape", "cylinder", "'float phimax' 100"},
    SEEN("cylinder", ""),
    {"Shape", "disk", "'float height' 0.5"},
    {"Shape", "disk", "'float radius' 0.5"},
    {"Shape", "disk", "'float innerradius' 0.5"},
    {"Shape", "disk", "'float phimax' 100"},
    SEEN("disk", ""),
    {"Shape", "loopsubdiv",
     TETRA SIDES "## 'point3 P' [-1 -1 -1 1 -1 1 -1 1 1 1 0 -1] " SIDES},
    {"Shape", "loopsubdiv",
     TETRA SIDES "## 'integer indices' [0 2 1 0 3 2 0 1 3 1 2 3] " TETRA},
    {"Shape", "loopsubdiv", TETRA SIDES "|| 'integer levels' 1"},
    {"Shape", "loopsubdiv", TETRA SIDES "|| 'string scheme' 'loop'"},
    {"Shape", "loopsubdiv", TETRA SIDES "|| 'integer faceIndices' [0 1 2 3]"},
    SEEN("loopsubdiv", TETRA SIDES "|| "),
    {"Shape", "plymesh", "'string filename' 'a.ply' ## 'string filename' 'b.ply'"},
    {"Shape", "plymesh", "'string filename' 'a.ply' || 'texture displacement' 'waves'"},
    {"Shape", "plymesh",
     "'string filename' 'a.ply' || 'float displacement.edgelength' 0.1"},
    SEEN("plymesh", "'string filename' 'a.ply' || "),
    {"Shape", "sphere", "'float radius' 0.5"},
    {"Shape", "sphere", "'float zmin' -0.3"},
    {"Shape", "sphere", "'float zmax' 0.3"},
    {"Shape", "sphere", "'float phimax' 100"},
    SEEN("sphere", ""),
    {"Shape", "trianglemesh", FACES QUAD "## " BENT FACES},
    {"Shape", "trianglemesh", FACES QUAD "|| " TILTED},
    {"Shape", "trianglemesh", FACES QUAD "|| 'vector3 S' [0 1 0 0 1 0 0 1 0 0 1 0]"},
    {"Shape", "trianglemesh", FACES QUAD "|| 'point2 uv' [0 0 3 0 0 3 3 3]"},
    {"Shape", "trianglemesh", FACES QUAD "## 'integer indices' [0 1 2] " QUAD},
    {"Shape", "trianglemesh", FACES QUAD "|| 'integer faceIndices' [0 1]"},
    SEEN("trianglemesh", FACES QUAD "|| "),
    {"LightSource", "distant", "'rgb L' [3 2 1]"},
    {"LightSource", "distant", "'float illuminance' 5"},
    {"LightSource", "distant", "'point3 from' [1 0 0]"},
    {"LightSource", "distant", "'point3 to' [1 0 1]"},
    LIT("distant", ""),
    {"LightSource", "goniometric", "'rgb I' [3 2 1]"},
    {"LightSource", "goniometric", "'float power' 50"},
    {"LightSource", "goniometric", "'string filename' 'square.pfm'"},
    LIT("goniometric", ""),
    {"LightSource", "infinite", "'rgb L' [3 2 1]"},
    {"LightSource", "infinite", "'string filename' 'square.pfm'"},
    {"LightSource", "infinite", "'float illuminance' 5"},
    {"LightSource", "infinite",
     "'string filename' 'square.pfm' || 'point3 portal' [-2 3 -2 2 3 -2 2 3 2 -2 3 2]"},
    LIT("infinite", ""),
    {"LightSource", "point", "'rgb I' [3 2 1]"},
    {"LightSource", "point", "'float power' 50"},
    {"LightSource", "point", "'point3 from' [0 1 0]"},
    LIT("point", ""),
    {"LightSource", "projection",
     "'string filename' 'square.pfm' ## 'string filename' 'map.png'"},
    {"LightSource", "projection", "'string filename' 'square.pfm' || 'float fov' 20"},
    {"LightSource", "projection", "'string filename' 'square.pfm' || 'float power' 50"},
    LIT("projection", "'string filename' 'square.pfm' || "),
    {"LightSource", "spot", "'rgb I' [3 2 1]"},
    {"LightSource", "spot", "'float power' 50"},
    {"LightSource", "spot", "'point3 from' [0.5 0 0]"},
    {"LightSource", "spot", "'point3 to' [0.3 0 1]"},
    {"LightSource", "spot", "'float coneangle' 10"},
    {"LightSource", "spot", "'float conedeltaangle' 25"},
    LIT("spot", ""),
    {"AreaLightSource", "diffuse", "'rgb L' [3 2 1]"},
    {"AreaLightSource", "diffuse", "'texture L' 'check'"},
    {"AreaLightSource", "diffuse", "'string filename' 'map.png'"},
    {"AreaLightSource", "diffuse", "'float scale' 2"},
    {"AreaLightSource", "diffuse", "'float power' 50"},
    {"AreaLightSource", "diffuse", "'bool twosided' true"},
    {"AreaLightSource", "diffuse", "'string group' 'key'"},
    {"Material", "coatedconductor", "'float interface.eta' 1.9"},
    ROUGH("coatedconductor", "interface."),
    ROUGH("coatedconductor", "conductor."),
    {"Material", "coatedconductor", "'spectrum conductor.eta' 'metal-Au-eta'"},
    {"Material", "coatedconductor", "'texture conductor.eta' 'check'"},
    {"Material", "coatedconductor", "'spectrum conductor.k' 'metal-Ag-k'"},
    {"Material", "coatedconductor", "'texture conductor.k' 'check'"},
    {"Material", "coatedconductor", "'rgb reflectance' [0.9 0.5 0.2]"},
    {"Material", "coatedconductor", "'texture reflectance' 'check'"},
    COAT("coatedconductor"),
    BUMPY("coatedconductor"),
    {"Material", "coateddiffuse", "'rgb reflectance' [0.9 0.5 0.2]"},
    {"Material", "coateddiffuse", "'texture reflectance' 'check'"},
    {"Material", "coateddiffuse", "'float eta' 1.9"},
    {"Material", "coateddiffuse", "'spectrum eta' 'glass-F11'"},
    {"Material", "coateddiffuse", "'integer maxdepth' 1"},
    ROUGH("coateddiffuse", ""),
    COAT("coateddiffuse"),
    BUMPY("coateddiffuse"),
    {"Material", "conductor", "'spectrum eta' 'metal-Au-eta'"},
    {"Material", "conductor", "'texture eta' 'check'"},
    {"Material", "conductor", "'spectrum k' 'metal-Ag-k'"},
    {"Material", "conductor", "'texture k' 'check'"},
    {"Material", "conductor", "'rgb reflectance' [0.9 0.5 0.2]"},
    ROUGH("conductor", ""),
    BUMPY("conductor"),
    {"Material", "dielectric", "'float eta' 1.9"},
    {"Material", "dielectric", "'spectrum eta' 'glass-F11'"},
    {"Material", "dielectric", "'rgb tint' [0.9 0.5 0.2]"},
    {"Material", "dielectric", "'texture tint' 'check'"},
    {"Material", "dielectric",
     "'rgb attenuationcolor' [0.5 0.9 0.5] 'float attenuationdistance' 1 ## "
     "'float attenuationdistance' 2 'rgb attenuationcolor' [0.5 0.9 0.5]"},
    {"Material", "dielectric",
     "'rgb attenuationcolor' [0.5 0.9 0.5] 'float attenuationdistance' 1 ## "
     "'rgb attenuationcolor' [0.5 0.5 0.9] 'float attenuationdistance' 1"},
    {"Material", "dielectric", "'rgb absorption' [1 2 3]"},
    ROUGH("dielectric", ""),
    BUMPY("dielectric"),
    {"Material", "diffuse", "'rgb reflectance' [0.9 0.5 0.2]"},
    {"Material", "diffuse", "'texture reflectance' 'check'"},
    BUMPY("diffuse"),
    {"Material", "diffusetransmission", "'rgb reflectance' [0.9 0.5 0.2]"},
    {"Material", "diffusetransmission", "'rgb transmittance' [0.2 0.5 0.7]"},
    {"Material", "diffusetransmission", "'texture transmittance' 'check'"},
    {"Material", "diffusetransmission", "'float scale' 0.5"},
    BUMPY("diffusetransmission"),
    {"Material", "mix",
     "'string materials' ['red' 'steel'] ## 'string materials' ['steel' 'red']"},
    {"Material", "mix", "'string materials' ['red' 'steel'] || 'float amount' 0.9"},
    {"Material", "mix",
     "'string materials' ['red' 'steel'] || 'texture amount' 'dotted'"},
    {"Material", "mix",
     "'string materials' ['red' 'steel'] || 'string normalmap' 'normals.pfm'"},
    {"Material", "mix",
     "'string materials' ['red' 'steel'] 'string normalmap' 'normals.pfm' || 'float "
     "normalscale' 3"},
    {"Material", "mix",
     "'string materials' ['red' 'steel'] || 'texture displacement' 'waves'"},
    {"Material", "thindielectric", "'float eta' 1.9"},
    BUMPY("thindielectric"),
    {"Texture", "bilerp", "'rgb v00' [1 0 0]"},
    {"Texture", "bilerp", "'rgb v01' [0 1 0]"},
    {"Texture", "bilerp", "'rgb v10' [1 0 0]"},
    {"Texture", "bilerp", "'rgb v11' [0 1 0]"},
    MAPPED("bilerp", "", ""),
    PLANAR("bilerp", ""),
    {"Texture", "checkerboard", "'rgb tex1' [1 0 0]"},
    {"Texture", "checkerboard", "'float uscale' 4 || 'rgb tex2' [1 0 0]"},
    {"Texture", "checkerboard", "'integer dimension' 3"},
    MAPPED("checkerboard", "", SCALED),
    PLANAR("checkerboard", ""),
    {"Texture", "constant", "'rgb value' [1 0 0]"},
    {"Texture", "directionmix", "'rgb tex1' [1 0 0]"},
    {"Texture", "directionmix", "'rgb tex2' [1 0 0]"},
    {"Texture", "directionmix", "'vector3 dir' [1 0 1]"},
    {"Texture", "dots", "'rgb inside' [1 0 0]"},
    {"Texture", "dots", "'rgb outside' [0.3 1 0]"},
    MAPPED("dots", "", SCALED),
    PLANAR("dots", ""),
    {"Texture", "fbm", "'integer octaves' 2"},
    {"Texture", "fbm", "'float roughness' 0.9"},
    {"Texture", "imagemap",
     "'string filename' 'square.pfm' ## 'string filename' 'map.png'"},
    {"Texture", "imagemap", PICTURE_MAP "'float uscale' 3 || 'string wrap' 'black'"},
    {"Texture", "imagemap", PICTURE_MAP "|| 'string filter' 'point'"},
    {"Texture", "imagemap",
     PICTURE_MAP "'string filter' 'EWA' || 'float maxanisotropy' 2"},
    {"Texture", "imagemap", PICTURE_MAP "|| 'string encoding' 'linear'"},
    {"Texture", "imagemap", PICTURE_MAP "|| 'float scale' 0.5"},
    {"Texture", "imagemap", PICTURE_MAP "|| 'bool invert' true"},
    MAPPED("imagemap", PICTURE_MAP, ""),
    PLANAR("imagemap", PICTURE_MAP),
    {"Texture", "marble", "'integer octaves' 2"},
    {"Texture", "marble", "'float roughness' 0.9"},
    {"Texture", "marble", "'float scale' 3"},
    {"Texture", "marble", "'float variation' 0.9"},
    {"Texture", "mix", "'rgb tex1' [1 0 0]"},
    {"Texture", "mix", "'rgb tex2' [1 0 0]"},
    {"Texture", "mix", "'float amount' 0.9"},
    {"Texture", "scale", "'rgb tex' [1 0 0]"},
    {"Texture", "scale", "'float scale' 0.3"},
    {"Texture", "wrinkled", "'integer octaves' 2"},
    {"Texture", "wrinkled", "'float roughness' 0.9"},
    {"MakeNamedMedium", "homogeneous", "'rgb sigma_a' [3 1 0]"},
    {"MakeNamedMedium", "homogeneous", "'rgb sigma_s' [3 1 0]"},
    {"MakeNamedMedium", "homogeneous", "'float scale' 3"},
    {"MakeNamedMedium", "homogeneous", "'float g' 0.8"},
    {"MakeNamedMedium", "homogeneous", "'string preset' 'Ketchup'"},
    {"MakeNamedMedium", "homogeneous", "'rgb Le' [0 0 0]"},
    {"MakeNamedMedium", "homogeneous", "'float Lescale' 3"},
};
