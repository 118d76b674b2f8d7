// SPDX-License-Identifier: Apache-2.0
// What is known of one property of a glTF file, and short ways to write it down.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "io/base/json_cursor.h"

namespace petzval {

enum class PropertyKind : uint8_t {
    Number,
    Numbers,  ///< an array
    Turn,     ///< an array of four: a quaternion
    Yes,      ///< true or false
    Word,     ///< one of some texts
    Texture   ///< a slot: an object that names a texture
};

/// What is done with a value that is of the right type and cannot be.
enum class Mending : uint8_t {
    None,          ///< it is refused
    Clamp,         ///< it is moved into the range; arrays get their length where they are one short
    Zero,          ///< likewise, but 0 has a meaning of its own
    Emission,      ///< likewise, but what is above 1 is taken as it stands
    DropUnlessLit  ///< a number that is not above 0 is taken away
};

/// What a slot reads of its texture.
enum class TexelUse : uint8_t { Data, Colours, Alpha };

/// One property.
struct GltfProperty {
    /// Keys that lead from the thing to the object that has it, with a slash between them.
    std::string_view place{};
    const char* key = "";
    PropertyKind kind = PropertyKind::Number;
    size_t width = 1;                ///< numbers of an array; 0: as many as there are morph targets
    std::array<double, 4> preset{};  ///< the default; where it has none, nothing reads this
    Range range{};
    Mending mending = Mending::None;
    std::string_view words{};  ///< those that are known, with spaces between; the default is first
    TexelUse texels = TexelUse::Data;
    bool animated = false;  ///< an animation may change it
};

/// Makers of rows, and the ranges in them.
namespace schema {

inline constexpr Range kAny = {}, kUnit = {0, 1}, kNotNegative = {0, Range().high};
inline constexpr Range kFromOne = {1, Range().high}, kRightAngle = {0, std::numbers::pi / 2};
/// Intensities whose products stay in a float.
inline constexpr Range kSky = {0, 1e20};
inline constexpr auto kInfinite = std::numeric_limits<double>::infinity();

constexpr GltfProperty number(std::string_view place, const char* key, double preset, Range range,
                              Mending mending = Mending::Clamp) {
    return {.place = place,
            .key = key,
            .preset = {preset},
            .range = range,
            .mending = mending,
            .animated = true};
}

/// `width` numbers with one default.
constexpr GltfProperty numbers(std::string_view place, const char* key, size_t width, double preset,
                               Range range, Mending mending = Mending::Clamp) {
    GltfProperty row = number(place, key, preset, range, mending);
    row.kind = PropertyKind::Numbers;
    row.width = width;
    row.preset.fill(preset);
    return row;
}

constexpr GltfProperty turn(std::string_view place, const char* key) {
    return {.place = place,
            .key = key,
            .kind = PropertyKind::Turn,
            .width = 4,
            .preset = {0, 0, 0, 1},
            .animated = true};
}

constexpr GltfProperty yes(std::string_view place, const char* key, bool preset, bool animated) {
    return {.place = place,
            .key = key,
            .kind = PropertyKind::Yes,
            .preset = {preset ? 1. : 0.},
            .animated = animated};
}

constexpr GltfProperty word(const char* key, std::string_view words) {
    return {.key = key, .kind = PropertyKind::Word, .words = words};
}

constexpr GltfProperty texture(std::string_view place, const char* key, TexelUse texels) {
    return {.place = place, .key = key, .kind = PropertyKind::Texture, .texels = texels};
}

inline constexpr auto kKept = Mending::None;

}  // namespace schema

}  // namespace petzval
