/* The list of glTF's extensions. */
#include "format/gltf/gltf_extensions.h"

#include <string.h>

static const gltf_extension_row rows[] = {
    {"KHR_lights_punctual", GLTF_RENDERED,
     "1 cd/m² is a radiance of 1; Blender's 683 lm for 1 W are taken back, and spot "
     "lights of its files fade as in Blender"},
    {"KHR_materials_anisotropy", GLTF_RENDERED, ""},
    {"KHR_materials_clearcoat", GLTF_APPROXIMATED, "with the surface's own normals"},
    {"KHR_materials_diffuse_transmission", GLTF_RENDERED, ""},
    {"KHR_materials_dispersion", GLTF_RENDERED, "Cauchy's formula with the Abbe number"},
    {"KHR_materials_emissive_strength", GLTF_RENDERED, ""},
    {"KHR_materials_ior", GLTF_RENDERED, ""},
    {"KHR_materials_pbrSpecularGlossiness", GLTF_APPROXIMATED,
     "what is not reflected is scattered, whatever the specular colour"},
    {"KHR_materials_specular", GLTF_RENDERED,
     "what reflects less than 2 % is dimmed at grazing angles too"},
    {"KHR_materials_transmission", GLTF_RENDERED,
     "a thin pane; closed meshes are read as solid glass, with a note"},
    {"KHR_materials_unlit", GLTF_APPROXIMATED,
     "shines with its base colour, which lights other things too"},
    {"KHR_materials_volume", GLTF_RENDERED,
     "absorption over the way that light goes; thickness above 0 means solid"},
    {"KHR_mesh_quantization", GLTF_RENDERED, ""},
    {"KHR_texture_transform", GLTF_RENDERED, "of all maps"},
    {"EXT_mesh_gpu_instancing", GLTF_RENDERED, "what shines is copied"},
    {"KHR_node_visibility", GLTF_RENDERED, "as the file begins"},
    {"ADOBE_materials_clearcoat_specular", GLTF_LEFT_OUT, "a coat has an index of 1.5"},
    {"ADOBE_materials_clearcoat_tint", GLTF_LEFT_OUT, "a coat is clear"},
    {"ADOBE_materials_thin_transparency", GLTF_LEFT_OUT, ""},
    {"EXT_lights_ies", GLTF_LEFT_OUT, "the light shines the same all around"},
    {"EXT_lights_image_based", GLTF_LEFT_OUT, ""},
    {"EXT_mesh_features", GLTF_LEFT_OUT, "says nothing of how it looks"},
    {"EXT_structural_metadata", GLTF_LEFT_OUT, "says nothing of how it looks"},
    {"KHR_animation_pointer", GLTF_LEFT_OUT, ""},
    {"KHR_audio_emitter", GLTF_LEFT_OUT, ""},
    {"KHR_interactivity", GLTF_LEFT_OUT, "the scene stands as it begins"},
    {"KHR_materials_iridescence", GLTF_LEFT_OUT, ""},
    {"KHR_materials_sheen", GLTF_LEFT_OUT, ""},
    {"KHR_materials_variants", GLTF_LEFT_OUT, "the first look is shown"},
    {"KHR_materials_volume_scatter", GLTF_LEFT_OUT, "the volume only absorbs"},
    {"KHR_node_hoverability", GLTF_LEFT_OUT, ""},
    {"KHR_node_selectability", GLTF_LEFT_OUT, ""},
    {"KHR_techniques_webgl", GLTF_LEFT_OUT, "the material is the plain one beside it"},
    {"KHR_xmp", GLTF_LEFT_OUT, "says nothing of how it looks"},
    {"KHR_xmp_json_ld", GLTF_LEFT_OUT, "says nothing of how it looks"},
    {"MSFT_lod", GLTF_LEFT_OUT, "the finest is shown"},
    {"EXT_meshopt_compression", GLTF_REFUSED, ""},
    {"EXT_texture_avif", GLTF_REFUSED, "unless a PNG or JPEG stands beside it"},
    {"EXT_texture_webp", GLTF_REFUSED, "unless a PNG or JPEG stands beside it"},
    {"KHR_draco_mesh_compression", GLTF_REFUSED, ""},
    {"KHR_gaussian_splatting", GLTF_REFUSED, ""},
    {"KHR_meshopt_compression", GLTF_REFUSED, ""},
    {"KHR_texture_basisu", GLTF_REFUSED, "unless a PNG or JPEG stands beside it"},
    {"MSFT_texture_dds", GLTF_REFUSED, "unless a PNG or JPEG stands beside it"},
};

const gltf_extension_row *gltf_find_extension(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(rows); i++)
        if (strcmp(rows[i].name, name) == 0)
            return &rows[i];
    return NULL;
}

/* What the standard itself has that is not plain. */
static const gltf_extension_row core[] = {
    {"skins", GLTF_RENDERED,
     "in the pose of the joints at rest; copies of one by "
     "EXT_mesh_gpu_instancing are left out"},
    {"morph targets", GLTF_RENDERED, "by the weights of the node, else of the mesh"},
    {"animations", GLTF_RENDERED,
     "the first, of nodes and morph targets, at the times of --frame; else the scene "
     "stands as it begins"},
    {"points and lines", GLTF_LEFT_OUT, ""},
};

static void append_rows(GString *out, const gltf_extension_row *row, size_t n)
{
    static const char *const words[] = {[GLTF_RENDERED] = "rendered",
                                        [GLTF_APPROXIMATED] = "approximated",
                                        [GLTF_LEFT_OUT] = "left out, with a note",
                                        [GLTF_REFUSED] = "refused"};
    const char *quote = row == core ? "" : "`";
    for (size_t i = 0; i < n; i++)
        g_string_append_printf(out, "| %s%s%s | %s | %s |\n", quote, row[i].name, quote,
                               words[row[i].support], row[i].note);
}

void gltf_append_features(GString *out)
{
    g_string_append(out, "\n| glTF 2.0 | | |\n|---|---|---|\n");
    append_rows(out, core, G_N_ELEMENTS(core));
    append_rows(out, rows, G_N_ELEMENTS(rows));
}
