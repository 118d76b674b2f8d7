// SPDX-License-Identifier: Apache-2.0
// A glTF file at a moment of its animations.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/animation/clip.h"

namespace petzval {

/// Words of a pointer: "nodes", "3" and "scale" of /nodes/3/scale. They live as long as it does.
[[nodiscard]] std::vector<std::string_view> words_of(const std::string& pointer);

/// Kind of a property that can be animated, by where it stands: the glTF object model, and
/// KHR_animation_pointer.
struct PropertyKind {
    size_t width = 0;  ///< numbers; 0: as many as there are morph targets
    bool list = false;
    bool yes_or_no = false;
    bool quaternion = false;
};

/// Kind of the property that a pointer names; nothing for one that Petzval does not read.
[[nodiscard]] std::optional<PropertyKind> property_kind(const std::string& pointer);

/// Makes the JSON say what the clips say at a time, as GltfClip::local_s has it. What a pointer
/// names must be there, but for properties that have a default.
void pose(nlohmann::json& root, std::span<const GltfClip>, double time_s, double frame_s,
          bool repeats);

}  // namespace petzval
