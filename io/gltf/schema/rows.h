// SPDX-License-Identifier: Apache-2.0
// The properties of a glTF file that are mended, checked, read and animated by their rows. Ranges
// and defaults are those of glTF 2.0 and of the texts of the extensions
// (github.com/KhronosGroup/glTF, extensions/2.0).
#pragma once

#include <numbers>

#include "io/gltf/schema/property.h"

namespace petzval {
namespace schema {

using enum TexelUse;
inline constexpr std::string_view kPbr = "pbrMetallicRoughness",
                                  kGlossy = "extensions/KHR_materials_pbrSpecularGlossiness",
                                  kSpecular = "extensions/KHR_materials_specular",
                                  kTransmission = "extensions/KHR_materials_transmission",
                                  kVolume = "extensions/KHR_materials_volume",
                                  kCoat = "extensions/KHR_materials_clearcoat",
                                  kSheen = "extensions/KHR_materials_sheen",
                                  kAnisotropy = "extensions/KHR_materials_anisotropy",
                                  kIridescence = "extensions/KHR_materials_iridescence",
                                  kLeaf = "extensions/KHR_materials_diffuse_transmission";

inline constexpr GltfProperty kMaterialRows[] = {
    numbers(kPbr, "baseColorFactor", 4, 1, kUnit),
    number(kPbr, "metallicFactor", 1, kUnit),
    number(kPbr, "roughnessFactor", 1, kUnit),
    texture(kPbr, "baseColorTexture", Colours),
    texture(kPbr, "metallicRoughnessTexture", Data),
    number("normalTexture", "scale", 1, kAny, kKept),
    number("occlusionTexture", "strength", 1, kUnit),
    texture("", "normalTexture", Data),
    texture("", "occlusionTexture", Data),
    numbers("", "emissiveFactor", 3, 0, kNotNegative, Mending::Emission),
    texture("", "emissiveTexture", Colours),
    word("alphaMode", "OPAQUE MASK BLEND"),
    number("", "alphaCutoff", 0.5, kNotNegative),
    yes("", "doubleSided", false, false),
    number("extensions/KHR_materials_dispersion", "dispersion", 0, kNotNegative),
    number("extensions/KHR_materials_emissive_strength", "emissiveStrength", 1, kNotNegative),
    number("extensions/KHR_materials_ior", "ior", 1.5, kFromOne, Mending::Zero),
    number(kSpecular, "specularFactor", 1, kUnit),
    texture(kSpecular, "specularTexture", Alpha),
    numbers(kSpecular, "specularColorFactor", 3, 1, kNotNegative),
    texture(kSpecular, "specularColorTexture", Colours),
    numbers(kGlossy, "diffuseFactor", 4, 1, kUnit),
    numbers(kGlossy, "specularFactor", 3, 1, kUnit),
    number(kGlossy, "glossinessFactor", 1, kUnit),
    texture(kGlossy, "diffuseTexture", Colours),
    texture(kGlossy, "specularGlossinessTexture", Colours),
    number(kTransmission, "transmissionFactor", 0, kUnit),
    texture(kTransmission, "transmissionTexture", Data),
    number(kVolume, "thicknessFactor", 0, kNotNegative),
    number(kVolume, "attenuationDistance", kInfinite, kNotNegative, Mending::DropUnlessLit),
    numbers(kVolume, "attenuationColor", 3, 1, kUnit),
    number(kCoat, "clearcoatFactor", 0, kUnit),
    texture(kCoat, "clearcoatTexture", Data),
    number(kCoat, "clearcoatRoughnessFactor", 0, kUnit),
    texture(kCoat, "clearcoatRoughnessTexture", Data),
    texture(kCoat, "clearcoatNormalTexture", Data),
    number("extensions/KHR_materials_clearcoat/clearcoatNormalTexture", "scale", 1, kAny, kKept),
    numbers(kSheen, "sheenColorFactor", 3, 0, kUnit),
    texture(kSheen, "sheenColorTexture", Colours),
    number(kSheen, "sheenRoughnessFactor", 0, kUnit),
    texture(kSheen, "sheenRoughnessTexture", Alpha),
    number(kAnisotropy, "anisotropyStrength", 0, kUnit),
    number(kAnisotropy, "anisotropyRotation", 0, kAny, kKept),
    texture(kAnisotropy, "anisotropyTexture", Data),
    number(kIridescence, "iridescenceFactor", 0, kUnit),
    texture(kIridescence, "iridescenceTexture", Data),
    number(kIridescence, "iridescenceIor", 1.3, kFromOne),
    number(kIridescence, "iridescenceThicknessMinimum", 100, kNotNegative),
    number(kIridescence, "iridescenceThicknessMaximum", 400, kNotNegative),
    texture(kIridescence, "iridescenceThicknessTexture", Data),
    number(kLeaf, "diffuseTransmissionFactor", 0, kUnit),
    texture(kLeaf, "diffuseTransmissionTexture", Alpha),
    numbers(kLeaf, "diffuseTransmissionColorFactor", 3, 1, kUnit),
    texture(kLeaf, "diffuseTransmissionColorTexture", Colours),
};

/// Angles, widths and planes are mended together (io/gltf/mend/mend_cameras.cpp).
inline constexpr GltfProperty kCameraRows[] = {
    number("perspective", "yfov", 0, kNotNegative, kKept),
    number("perspective", "znear", 0, kNotNegative, kKept),
    number("perspective", "aspectRatio", 0, kNotNegative, kKept),
    number("perspective", "zfar", kInfinite, kNotNegative, kKept),
    number("orthographic", "xmag", 0, kAny, kKept),
    number("orthographic", "ymag", 0, kAny, kKept),
    number("orthographic", "zfar", 0, kNotNegative, kKept),
    number("orthographic", "znear", 0, kNotNegative, kKept),
};

inline constexpr GltfProperty kLightRows[] = {
    numbers("", "color", 3, 1, kNotNegative),
    number("", "intensity", 1, kNotNegative),
    number("", "range", kInfinite, kNotNegative, kKept),
    number("spot", "innerConeAngle", 0, kRightAngle, kKept),
    number("spot", "outerConeAngle", std::numbers::pi / 4, kRightAngle),
};

inline constexpr GltfProperty kImageLightRows[] = {
    number("", "intensity", 1, kSky, kKept),
    turn("", "rotation"),
};

inline constexpr GltfProperty kNodeRows[] = {
    numbers("", "translation", 3, 0, kAny, kKept),
    numbers("", "scale", 3, 1, kAny, kKept),
    turn("", "rotation"),
    numbers("", "weights", 0, 0, kAny, kKept),
    number("extensions/EXT_lights_ies", "multiplier", 1, kNotNegative, kKept),
    numbers("extensions/EXT_lights_ies", "color", 3, 1, kNotNegative, kKept),
    yes("extensions/KHR_node_visibility", "visible", true, true),
};

inline constexpr GltfProperty kMeshRows[] = {
    numbers("", "weights", 0, 0, kAny, kKept),
};

/// One of the weights of a node or mesh.
inline constexpr GltfProperty kWeightRow = number("weights", "", 0, kAny, kKept);

inline constexpr GltfProperty kSlotRows[] = {
    numbers("extensions/KHR_texture_transform", "offset", 2, 0, kAny, kKept),
    numbers("extensions/KHR_texture_transform", "scale", 2, 1, kAny, kKept),
    number("extensions/KHR_texture_transform", "rotation", 0, kAny, kKept),
};

}  // namespace schema
}  // namespace petzval
