// SPDX-License-Identifier: Apache-2.0
// Names and places follow the extensions' own texts in Khronos' registry
// (github.com/KhronosGroup/glTF, extensions/2.0) and in those of VRM and OMI.
#include "io/gltf/schema/extensions.h"

#include <algorithm>
#include <array>

namespace petzval::io {
namespace {

using enum ExtensionUse;

constexpr std::string_view kMetadata = "describes, and shows nothing";
constexpr std::string_view kStill = "nothing moves in a picture";
constexpr std::string_view kSound = "pictures are silent";
constexpr std::string_view kDrawnLook = "drawn looks (MToon) are shaded as real surfaces";
constexpr std::string_view kPacked = "the same textures stand in the core material";
constexpr std::string_view kImageBeside = "textures show the images beside it";

constexpr auto kExtensions = std::to_array<GltfExtension>({
    {"ADOBE_materials_clearcoat_specular", Ignored,
     "clear coats reflect as those of an index of 1.5 do", "materials"},
    {"ADOBE_materials_clearcoat_tint", Ignored, "clear coats have no colour of their own",
     "materials"},
    {"ADOBE_materials_thin_transparency", Ignored, "thin glass looks opaque", "materials"},
    {"AGI_articulations", Harmless, kStill, ""},
    {"AGI_stk_metadata", Harmless, kMetadata, ""},
    {"CESIUM_primitive_outline", Ignored, "edges have no drawn lines", "primitives"},
    {"EXT_feature_metadata", Harmless, kMetadata, ""},
    {"EXT_instance_features", Harmless, kMetadata, ""},
    {"EXT_lights_ies", Rendered, "", "root nodes"},
    {"EXT_lights_image_based", Rendered, "", "root scenes"},
    {"EXT_mesh_features", Harmless, kMetadata, ""},
    {"EXT_mesh_gpu_instancing", Rendered, "", "nodes"},
    {"EXT_mesh_manifold", Harmless, "it tells solids to programs that print them", "meshes"},
    {"EXT_mesh_primitive_edge_visibility", Ignored, "edges have no drawn lines", "primitives"},
    {"EXT_meshopt_compression", Rendered, "", "buffers bufferViews"},
    {"EXT_structural_metadata", Harmless, kMetadata, ""},
    {"EXT_texture_avif", Needed, kImageBeside, "textures"},
    {"EXT_texture_webp", Rendered, "", "textures"},
    {"FB_geometry_metadata", Harmless, kMetadata, ""},
    {"GODOT_single_root", Harmless, kMetadata, ""},
    {"GRIFFEL_bim_data", Harmless, kMetadata, ""},
    {"KHR_animation_pointer", Rendered, "", "target"},
    {"KHR_audio_emitter", Harmless, kSound, ""},
    {"KHR_draco_mesh_compression", Rendered, "", "primitives"},
    {"KHR_gaussian_splatting", Needed, "splats are not shown", "primitives"},
    {"KHR_implicit_shapes", Harmless, "shapes for physics are not seen", ""},
    {"KHR_interactivity", Harmless, kStill, ""},
    {"KHR_lights_punctual", Rendered, "", "root nodes"},
    {"KHR_materials_anisotropy", Rendered, "", "materials"},
    {"KHR_materials_clearcoat", Rendered, "", "materials"},
    {"KHR_materials_diffuse_transmission", Rendered, "", "materials"},
    {"KHR_materials_dispersion", Rendered, "", "materials"},
    {"KHR_materials_emissive_strength", Rendered, "", "materials"},
    {"KHR_materials_ior", Rendered, "", "materials"},
    {"KHR_materials_iridescence", Rendered, "", "materials"},
    {"KHR_materials_pbrSpecularGlossiness", Rendered, "", "materials"},
    {"KHR_materials_sheen", Rendered, "", "materials"},
    {"KHR_materials_specular", Rendered, "", "materials"},
    {"KHR_materials_transmission", Rendered, "", "materials"},
    {"KHR_materials_unlit", Rendered, "", "materials"},
    {"KHR_materials_variants", Rendered, "", "root primitives"},
    {"KHR_materials_volume", Rendered, "", "materials"},
    {"KHR_materials_volume_scatter", Ignored,
     "wax, skin and milk are clear inside: no light scatters there", "materials"},
    {"KHR_mesh_quantization", Rendered, "", ""},
    {"KHR_meshopt_compression", Rendered, "", "buffers bufferViews"},
    {"KHR_node_hoverability", Harmless, kStill, "nodes"},
    {"KHR_node_selectability", Harmless, kStill, "nodes"},
    {"KHR_node_visibility", Rendered, "", "nodes"},
    {"KHR_physics_rigid_bodies", Harmless, kStill, ""},
    {"KHR_techniques_webgl", Needed, "surfaces that programs for graphics cards colour are white",
     ""},
    {"KHR_texture_basisu", Needed, kImageBeside, "textures"},
    {"KHR_texture_transform", Rendered, "", "*Texture"},
    {"KHR_xmp", Harmless, kMetadata, ""},
    {"KHR_xmp_json_ld", Harmless, kMetadata, ""},
    {"MSFT_audio_emitter", Harmless, kSound, ""},
    {"MSFT_lod", Harmless, "the finest level is shown", "nodes materials"},
    {"MSFT_packing_normalRoughnessMetallic", Harmless, kPacked, "materials"},
    {"MSFT_packing_occlusionRoughnessMetallic", Harmless, kPacked, "materials"},
    {"MSFT_screencoverage", Harmless, "the finest level is shown", ""},
    {"MSFT_texture_dds", Needed, kImageBeside, "textures"},
    {"NV_materials_mdl", Ignored, "surfaces have the simpler material beside it", ""},
    {"OMI_physics_body", Harmless, kStill, ""},
    {"OMI_physics_shape", Harmless, "shapes for physics are not seen", ""},
    {"VRM", Ignored, kDrawnLook, "root"},
    {"VRMC_materials_hdr_emissiveMultiplier", Ignored, "glowing surfaces are dimmer or brighter",
     "materials"},
    {"VRMC_materials_mtoon", Ignored, kDrawnLook, "materials"},
    {"VRMC_node_constraint", Harmless, kStill, "nodes"},
    {"VRMC_springBone", Harmless, kStill, "root"},
    {"VRMC_vrm", Harmless, kMetadata, "root"},
});

static_assert(std::is_sorted(kExtensions.begin(), kExtensions.end(),
                             [](const GltfExtension& a, const GltfExtension& b) {
                                 return a.name < b.name;
                             }));

}  // namespace

std::span<const GltfExtension> gltf_extensions() {
    return kExtensions;
}

const GltfExtension* find_gltf_extension(std::string_view name) {
    const auto at = std::find_if(kExtensions.begin(), kExtensions.end(),
                                 [&](const GltfExtension& e) { return e.name == name; });
    return at == kExtensions.end() ? nullptr : &*at;
}

std::string_view gltf_extension_advice(std::string_view name) {
    if (name == "KHR_texture_basisu")
        return "convert its KTX2 images to PNG with the script in docs/guide/textures.md";
    if (name == "EXT_texture_avif")
        return "convert its AVIF images to PNG: npx @gltf-transform/cli png IN OUT --formats avif";
    if (name == "MSFT_texture_dds") return "export it with PNG, JPEG or WebP";
    return "export it without";
}

std::optional<JsonCursor> meshopt_extension(const JsonCursor& owner) {
    auto found = owner.extension("KHR_meshopt_compression");
    return found ? found : owner.extension("EXT_meshopt_compression");
}

}  // namespace petzval::io
