// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "io/gltf/animation/choice.h"

namespace petzval::io {

/// Choices that a glTF file leaves to its user.
struct GltfChoices {
    std::optional<std::string> scene{};    ///< its name or number; absent: the default scene
    std::optional<std::string> variant{};  ///< of its materials, by name or number; absent: none
    std::optional<float> point_line_radius_m{};  ///< of solids as which points and lines are drawn
    std::optional<AnimationChoice> animation{};  ///< absent: the pose that the file stores
    bool checks_all_animations = false;          ///< warns of faults in those that are not played

    [[nodiscard]] bool operator==(const GltfChoices&) const = default;
};

}  // namespace petzval::io
