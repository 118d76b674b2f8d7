// SPDX-License-Identifier: Apache-2.0
// Numbers in the extensions of materials, and their ranges by the texts of the extensions.
#pragma once

#include "io/base/json_cursor.h"

namespace petzval {

inline constexpr Range kUnit = {0, 1};
inline constexpr Range kNotNegative = {0, std::numeric_limits<float>::max()};

/// A number, or a list of `count` of them, each within the range.
struct MaterialProperty {
    const char* extension;
    const char* key;
    size_t count;
    Range range;
};

/// All but those that have a rule of their own: the distance of KHR_materials_volume, the index of
/// KHR_materials_ior, and what may be any number.
inline constexpr MaterialProperty kMaterialProperties[] = {
    {"KHR_materials_dispersion", "dispersion", 1, kNotNegative},
    {"KHR_materials_emissive_strength", "emissiveStrength", 1, kNotNegative},
    {"KHR_materials_transmission", "transmissionFactor", 1, kUnit},
    {"KHR_materials_specular", "specularFactor", 1, kUnit},
    {"KHR_materials_specular", "specularColorFactor", 3, kNotNegative},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseFactor", 4, kUnit},
    {"KHR_materials_pbrSpecularGlossiness", "specularFactor", 3, kUnit},
    {"KHR_materials_pbrSpecularGlossiness", "glossinessFactor", 1, kUnit},
    {"KHR_materials_volume", "thicknessFactor", 1, kNotNegative},
    {"KHR_materials_volume", "attenuationColor", 3, kUnit},
    {"KHR_materials_clearcoat", "clearcoatFactor", 1, kUnit},
    {"KHR_materials_clearcoat", "clearcoatRoughnessFactor", 1, kUnit},
    {"KHR_materials_sheen", "sheenRoughnessFactor", 1, kUnit},
    {"KHR_materials_sheen", "sheenColorFactor", 3, kUnit},
    {"KHR_materials_anisotropy", "anisotropyStrength", 1, kUnit},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", 1, kUnit},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor", 3, kUnit},
    {"KHR_materials_iridescence", "iridescenceFactor", 1, kUnit},
    {"KHR_materials_iridescence", "iridescenceIor", 1, {1, kNotNegative.high}},
    {"KHR_materials_iridescence", "iridescenceThicknessMinimum", 1, kNotNegative},
    {"KHR_materials_iridescence", "iridescenceThicknessMaximum", 1, kNotNegative},
};

}  // namespace petzval
