// SPDX-License-Identifier: Apache-2.0
// A glTF file at a moment of its animations.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/animation/clip.h"

namespace petzval::io {

/// Words of a pointer: "nodes", "3" and "scale" of /nodes/3/scale. They live as long as it does.
[[nodiscard]] std::vector<std::string_view> words_of(const std::string& pointer);

/// Makes the JSON say what the clips say at a time, as GltfClip::local_s has it. What a pointer
/// names must be there, but for properties that have a default.
void pose(nlohmann::json& root, std::span<const GltfClip>, double time_s, double frame_s,
          bool repeats);

}  // namespace petzval::io
