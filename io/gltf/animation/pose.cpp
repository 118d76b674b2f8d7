// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/pose.h"

#include <algorithm>
#include <array>

namespace petzval {
namespace {

using nlohmann::json;

bool is_number(std::string_view word) {
    return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

constexpr PropertyKind kNumber{.width = 1}, kPair{.width = 2, .list = true},
    kTriple{.width = 3, .list = true}, kFour{.width = 4, .list = true},
    kWeights{.width = 0, .list = true}, kTurn{.width = 4, .list = true, .quaternion = true};

struct Named {
    std::string_view parent;  ///< what it stands in; empty: an element of a list, mostly
    std::string_view name;
    PropertyKind kind;
};

/// Properties whose name tells what they are, where they stand in what glTF has them in.
constexpr std::array<Named, 43> kByName = {{
    {"perspective", "yfov", kNumber},
    {"perspective", "aspectRatio", kNumber},
    {"", "znear", kNumber},
    {"", "zfar", kNumber},
    {"orthographic", "xmag", kNumber},
    {"orthographic", "ymag", kNumber},
    {"", "alphaCutoff", kNumber},
    {"", "emissiveFactor", kTriple},
    {"occlusionTexture", "strength", kNumber},
    {"pbrMetallicRoughness", "baseColorFactor", kFour},
    {"pbrMetallicRoughness", "metallicFactor", kNumber},
    {"pbrMetallicRoughness", "roughnessFactor", kNumber},
    {"KHR_materials_anisotropy", "anisotropyStrength", kNumber},
    {"KHR_materials_anisotropy", "anisotropyRotation", kNumber},
    {"KHR_materials_clearcoat", "clearcoatFactor", kNumber},
    {"KHR_materials_clearcoat", "clearcoatRoughnessFactor", kNumber},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", kNumber},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor", kTriple},
    {"KHR_materials_dispersion", "dispersion", kNumber},
    {"KHR_materials_emissive_strength", "emissiveStrength", kNumber},
    {"KHR_materials_ior", "ior", kNumber},
    {"KHR_materials_iridescence", "iridescenceFactor", kNumber},
    {"KHR_materials_iridescence", "iridescenceIor", kNumber},
    {"KHR_materials_iridescence", "iridescenceThicknessMinimum", kNumber},
    {"KHR_materials_iridescence", "iridescenceThicknessMaximum", kNumber},
    {"KHR_materials_sheen", "sheenColorFactor", kTriple},
    {"KHR_materials_sheen", "sheenRoughnessFactor", kNumber},
    {"KHR_materials_specular", "specularColorFactor", kTriple},
    {"KHR_materials_transmission", "transmissionFactor", kNumber},
    {"KHR_materials_volume", "thicknessFactor", kNumber},
    {"KHR_materials_volume", "attenuationDistance", kNumber},
    {"KHR_materials_volume", "attenuationColor", kTriple},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseFactor", kFour},
    {"KHR_materials_pbrSpecularGlossiness", "specularFactor", kTriple},
    {"KHR_materials_pbrSpecularGlossiness", "glossinessFactor", kNumber},
    {"", "color", kTriple},
    {"", "intensity", kNumber},
    {"", "range", kNumber},
    {"spot", "innerConeAngle", kNumber},
    {"spot", "outerConeAngle", kNumber},
    {"", "multiplier", kNumber},
    {"KHR_node_visibility", "visible", {.width = 1, .yes_or_no = true}},
    {"KHR_texture_transform", "offset", kPair},
}};

}  // namespace

std::vector<std::string_view> words_of(const std::string& pointer) {
    std::vector<std::string_view> words;
    for (size_t at = 0; at < pointer.size() && pointer[at] == '/';) {
        const size_t end = std::min(pointer.find('/', at + 1), pointer.size());
        words.push_back(std::string_view(pointer).substr(at + 1, end - at - 1));
        at = end;
    }
    return words;
}

std::optional<PropertyKind> property_kind(const std::string& pointer) {
    const auto words = words_of(pointer);
    if (words.size() < 3) return std::nullopt;
    const bool in_arrays = words[0] == "nodes" || words[0] == "meshes" || words[0] == "cameras" ||
                           words[0] == "materials";
    if (in_arrays ? !is_number(words[1]) : words[0] != "extensions") return std::nullopt;
    const std::string_view name = words.back(), parent = words[words.size() - 2];
    const bool of_node = name == "translation" || name == "rotation" || name == "scale";
    if (words[0] == "nodes" && (words.size() == 3) != (of_node || name == "weights") &&
        parent != "weights")
        return std::nullopt;  // its other properties are no numbers
    if (name == "weights") return kWeights;
    if (parent == "weights" && is_number(name)) return kNumber;
    if (of_node && parent == "KHR_texture_transform") {
        if (name == "rotation") return kNumber;
        return name == "scale" ? std::optional(kPair) : std::nullopt;
    }
    if (name == "rotation") {  // of a node, or of an image-based light
        if (words[0] == "nodes" || words[0] == "extensions") return kTurn;
        return std::nullopt;
    }
    if (name == "scale") {
        if (words[0] == "nodes") return kTriple;
        const bool of_normals = parent == "normalTexture" || parent == "clearcoatNormalTexture";
        return of_normals ? std::optional(kNumber) : std::nullopt;
    }
    if (name == "translation") return words[0] == "nodes" ? std::optional(kTriple) : std::nullopt;
    if (name == "specularFactor" && parent == "KHR_materials_specular") return kNumber;
    const auto found = std::ranges::find(kByName, name, &Named::name);
    if (found == kByName.end()) return std::nullopt;
    const bool fits = found->parent.empty()
                          ? is_number(parent) || parent == "EXT_lights_ies" || words[0] == "cameras"
                          : found->parent == parent;
    return fits ? std::optional(found->kind) : std::nullopt;
}

void pose(json& root, std::span<const GltfClip> clips, double time_s, double frame_s,
          bool repeats) {
    for (const GltfClip& clip : clips) {
        const double local_s = clip.local_s(time_s, frame_s, repeats);
        for (const AnimatedProperty& property : clip.properties) {
            const std::vector<double> values = property.keys.at(local_s);
            const PropertyKind kind = property_kind(property.pointer).value_or(kNumber);
            json& target = root[json::json_pointer(property.pointer)];
            if (kind.yes_or_no)
                target = values[0] != 0;
            else if (kind.list)
                target = values;
            else
                target = values[0];
        }
    }
}

}  // namespace petzval
