// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace petzval {

/// What of a glTF file is shown, where it leaves a choice.
struct GltfChoices {
    std::optional<std::string> scene;    ///< its name or number; absent: the default scene
    std::optional<std::string> variant;  ///< of its materials, by name or number; absent: none
    std::optional<float> point_line_radius_m;  ///< draws points and lines as solids of this radius

    [[nodiscard]] bool operator==(const GltfChoices&) const = default;
};

}  // namespace petzval
