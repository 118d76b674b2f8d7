// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/pose.h"

#include <algorithm>
#include <array>
#include <charconv>

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
    std::string_view name;
    PropertyKind kind;
};

/// Properties whose name alone tells what they are.
constexpr std::array<Named, 43> kByName = {{
    {"yfov", kNumber},
    {"aspectRatio", kNumber},
    {"znear", kNumber},
    {"zfar", kNumber},
    {"xmag", kNumber},
    {"ymag", kNumber},
    {"alphaCutoff", kNumber},
    {"emissiveFactor", kTriple},
    {"strength", kNumber},
    {"baseColorFactor", kFour},
    {"metallicFactor", kNumber},
    {"roughnessFactor", kNumber},
    {"anisotropyStrength", kNumber},
    {"anisotropyRotation", kNumber},
    {"clearcoatFactor", kNumber},
    {"clearcoatRoughnessFactor", kNumber},
    {"diffuseTransmissionFactor", kNumber},
    {"diffuseTransmissionColorFactor", kTriple},
    {"dispersion", kNumber},
    {"emissiveStrength", kNumber},
    {"ior", kNumber},
    {"iridescenceFactor", kNumber},
    {"iridescenceIor", kNumber},
    {"iridescenceThicknessMinimum", kNumber},
    {"iridescenceThicknessMaximum", kNumber},
    {"sheenColorFactor", kTriple},
    {"sheenRoughnessFactor", kNumber},
    {"specularColorFactor", kTriple},
    {"transmissionFactor", kNumber},
    {"thicknessFactor", kNumber},
    {"attenuationDistance", kNumber},
    {"attenuationColor", kTriple},
    {"diffuseFactor", kFour},
    {"glossinessFactor", kNumber},
    {"color", kTriple},
    {"intensity", kNumber},
    {"range", kNumber},
    {"innerConeAngle", kNumber},
    {"outerConeAngle", kNumber},
    {"multiplier", kNumber},
    {"visible", {.width = 1, .yes_or_no = true}},
    {"offset", kPair},
    {"translation", kTriple},
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
    if (words[0] == "nodes" && words.size() == 3 && !of_node && name != "weights")
        return std::nullopt;  // its other properties are no numbers
    if (name == "weights") return kWeights;
    if (parent == "weights" && is_number(name)) return kNumber;
    if (name == "rotation") {
        if (parent == "KHR_texture_transform") return kNumber;
        return kTurn;  // of a node, or of an image-based light
    }
    if (name == "scale") {
        if (parent == "KHR_texture_transform") return kPair;
        return words[0] == "nodes" ? kTriple : kNumber;  // of a node, or a normal map
    }
    if (name == "specularFactor")
        return parent == "KHR_materials_pbrSpecularGlossiness" ? kTriple : kNumber;
    const auto found = std::ranges::find(kByName, name, &Named::name);
    if (found == kByName.end()) return std::nullopt;
    return found->kind;
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
