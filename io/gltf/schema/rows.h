// SPDX-License-Identifier: Apache-2.0
// Table of the properties of a glTF file, a row each. Ranges and defaults are those of glTF 2.0 and
// of the texts of the extensions (github.com/KhronosGroup/glTF, extensions/2.0).
#pragma once

#include <limits>
#include <numbers>
#include <string_view>

#include "io/base/json_cursor.h"

namespace petzval::io {

enum class PropertyKind : uint8_t {
    Number,
    Pair,
    Triple,
    Four,     ///< an array of numbers, as the two before
    Turn,     ///< likewise: a quaternion
    Weights,  ///< likewise: as many numbers as there are morph targets
    Switch,   ///< true or false
    Yes,      ///< likewise, but no animation changes it
    Word,     ///< a text
    Data,
    Colours,
    Alpha  ///< a slot: an object that names a texture, and what is read of it, as the two before
};

/// Mending of numbers that are beyond their range. Without a range nothing is done.
enum class Mending : uint8_t {
    Clamp,               ///< they are moved into it; an array that is one short gets a last one
    ClampButZero,        ///< likewise, but 0 has a meaning of its own
    Emission,            ///< likewise, but what is above 1 is taken as it stands
    DropUnlessPositive,  ///< what is not above 0 is taken away
    Keep                 ///< it is refused, or mended with others (io/gltf/mend/mend_cameras.cpp)
};

/// One property.
struct GltfProperty {
    /// Keys that lead from the thing to the object that has it, with a slash between them.
    std::string_view place;
    const char* key;
    PropertyKind kind;
    double preset = 0;  ///< the default of each number; of a Turn, none
    Range range = {};
    Mending mending = Mending::Clamp;

    /// Numbers of an array; 0: that varies, or it is none.
    [[nodiscard]] constexpr size_t width() const {
        if (kind == PropertyKind::Turn) return 4;
        return kind <= PropertyKind::Four ? static_cast<size_t>(kind) + 1 : 0;
    }
    /// Whether an animation may change it.
    [[nodiscard]] constexpr bool animated() const { return kind <= PropertyKind::Switch; }
};

/// The tables. Rows of one place stand together.
namespace schema {

using enum PropertyKind;
using enum Mending;
inline constexpr Range kUnit = {0, 1}, kNotNegative = {0, Range().high};
inline constexpr Range kFromOne = {1, Range().high}, kRightAngle = {0, std::numbers::pi / 2};
inline constexpr Range kSky = {0, 1e20};  // its products with texels stay in a float
inline constexpr auto kInfinite = std::numeric_limits<double>::infinity();
inline constexpr std::string_view kPbr = "pbrMetallicRoughness",
                                  kGlossy = "extensions/KHR_materials_pbrSpecularGlossiness",
                                  kSpecular = "extensions/KHR_materials_specular",
                                  kTransmission = "extensions/KHR_materials_transmission",
                                  kVolume = "extensions/KHR_materials_volume",
                                  kScatter = "extensions/KHR_materials_volume_scatter",
                                  kCoat = "extensions/KHR_materials_clearcoat",
                                  kSheen = "extensions/KHR_materials_sheen",
                                  kAnisotropy = "extensions/KHR_materials_anisotropy",
                                  kIridescence = "extensions/KHR_materials_iridescence",
                                  kLeaf = "extensions/KHR_materials_diffuse_transmission";

inline constexpr GltfProperty kMaterialRows[] = {
    {kPbr, "baseColorFactor", Four, 1, kUnit},
    {kPbr, "metallicFactor", Number, 1, kUnit},
    {kPbr, "roughnessFactor", Number, 1, kUnit},
    {kPbr, "baseColorTexture", Colours},
    {kPbr, "metallicRoughnessTexture", Data},
    {"normalTexture", "scale", Number, 1},
    {"occlusionTexture", "strength", Number, 1, kUnit},
    {"", "normalTexture", Data},
    {"", "occlusionTexture", Data},
    {"", "emissiveFactor", Triple, 0, kNotNegative, Emission},
    {"", "emissiveTexture", Colours},
    {"", "alphaMode", Word},
    {"", "alphaCutoff", Number, 0.5, kNotNegative},
    {"", "doubleSided", Yes, 0},
    {"extensions/KHR_materials_dispersion", "dispersion", Number, 0, kNotNegative},
    {"extensions/KHR_materials_emissive_strength", "emissiveStrength", Number, 1, kNotNegative},
    {"extensions/KHR_materials_ior", "ior", Number, 1.5, kFromOne, ClampButZero},
    {kSpecular, "specularFactor", Number, 1, kUnit},
    {kSpecular, "specularTexture", Alpha},
    {kSpecular, "specularColorFactor", Triple, 1, kNotNegative},
    {kSpecular, "specularColorTexture", Colours},
    {kGlossy, "diffuseFactor", Four, 1, kUnit},
    {kGlossy, "specularFactor", Triple, 1, kUnit},
    {kGlossy, "glossinessFactor", Number, 1, kUnit},
    {kGlossy, "diffuseTexture", Colours},
    {kGlossy, "specularGlossinessTexture", Colours},
    {kTransmission, "transmissionFactor", Number, 0, kUnit},
    {kTransmission, "transmissionTexture", Data},
    {kVolume, "thicknessFactor", Number, 0, kNotNegative},
    {kVolume, "attenuationDistance", Number, kInfinite, kNotNegative, DropUnlessPositive},
    {kVolume, "attenuationColor", Triple, 1, kUnit},
    {kScatter, "multiscatterColor", Triple, 0, kUnit},
    {kScatter, "scatterAnisotropy", Number, 0, {-1, 1}},
    {kCoat, "clearcoatFactor", Number, 0, kUnit},
    {kCoat, "clearcoatTexture", Data},
    {kCoat, "clearcoatRoughnessFactor", Number, 0, kUnit},
    {kCoat, "clearcoatRoughnessTexture", Data},
    {kCoat, "clearcoatNormalTexture", Data},
    {"extensions/KHR_materials_clearcoat/clearcoatNormalTexture", "scale", Number, 1},
    {kSheen, "sheenColorFactor", Triple, 0, kUnit},
    {kSheen, "sheenColorTexture", Colours},
    {kSheen, "sheenRoughnessFactor", Number, 0, kUnit},
    {kSheen, "sheenRoughnessTexture", Alpha},
    {kAnisotropy, "anisotropyStrength", Number, 0, kUnit},
    {kAnisotropy, "anisotropyRotation", Number},
    {kAnisotropy, "anisotropyTexture", Data},
    {kIridescence, "iridescenceFactor", Number, 0, kUnit},
    {kIridescence, "iridescenceTexture", Data},
    {kIridescence, "iridescenceIor", Number, 1.3, kFromOne},
    {kIridescence, "iridescenceThicknessMinimum", Number, 100, kNotNegative},
    {kIridescence, "iridescenceThicknessMaximum", Number, 400, kNotNegative},
    {kIridescence, "iridescenceThicknessTexture", Data},
    {kLeaf, "diffuseTransmissionFactor", Number, 0, kUnit},
    {kLeaf, "diffuseTransmissionTexture", Alpha},
    {kLeaf, "diffuseTransmissionColorFactor", Triple, 1, kUnit},
    {kLeaf, "diffuseTransmissionColorTexture", Colours},
};

/// Angles, widths and planes are mended together (io/gltf/mend/mend_cameras.cpp).
inline constexpr GltfProperty kCameraRows[] = {
    {"perspective", "yfov", Number, 0, kNotNegative, Keep},
    {"perspective", "znear", Number, 0, kNotNegative, Keep},
    {"perspective", "aspectRatio", Number, 0, kNotNegative, Keep},
    {"perspective", "zfar", Number, kInfinite, kNotNegative, Keep},
    {"orthographic", "xmag", Number},
    {"orthographic", "ymag", Number},
    {"orthographic", "zfar", Number, 0, kNotNegative, Keep},
    {"orthographic", "znear", Number, 0, kNotNegative, Keep},
};

inline constexpr GltfProperty kLightRows[] = {
    {"", "color", Triple, 1, kNotNegative},
    {"", "intensity", Number, 1, kNotNegative},
    {"", "range", Number, kInfinite, kNotNegative, Keep},
    {"spot", "innerConeAngle", Number, 0, kRightAngle, Keep},
    {"spot", "outerConeAngle", Number, std::numbers::pi / 4, kRightAngle},
};

inline constexpr GltfProperty kImageLightRows[] = {
    {"", "intensity", Number, 1, kSky, Keep},
    {"", "rotation", Turn},
};

inline constexpr GltfProperty kNodeRows[] = {
    {"", "translation", Triple},
    {"", "scale", Triple, 1},
    {"", "rotation", Turn},
    {"", "weights", Weights},
    {"extensions/EXT_lights_ies", "multiplier", Number, 1, kNotNegative, Keep},
    {"extensions/EXT_lights_ies", "color", Triple, 1, kNotNegative, Keep},
    {"extensions/KHR_node_visibility", "visible", Switch, 1},
};

inline constexpr GltfProperty kMeshRows[] = {
    {"", "weights", Weights},
};

/// One of the weights of a node or mesh.
inline constexpr GltfProperty kWeightRow = {"weights", "", Number};

inline constexpr GltfProperty kSlotRows[] = {
    {"extensions/KHR_texture_transform", "offset", Pair},
    {"extensions/KHR_texture_transform", "scale", Pair, 1},
    {"extensions/KHR_texture_transform", "rotation", Number},
};

}  // namespace schema
}  // namespace petzval::io
