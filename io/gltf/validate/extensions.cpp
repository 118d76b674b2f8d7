// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/extensions.h"

#include <algorithm>
#include <array>

namespace petzval {
namespace {

constexpr std::array<std::string_view, 11> supported = {
    "EXT_texture_webp",           "KHR_lights_punctual",
    "KHR_materials_dispersion",   "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_volume",       "KHR_mesh_quantization",
    "KHR_texture_transform"};

}  // namespace

std::span<const std::string_view> supported_gltf_extensions() {
    return supported;
}

bool is_supported_gltf_extension(std::string_view name) {
    return std::find(supported.begin(), supported.end(), name) != supported.end();
}

}  // namespace petzval
