// SPDX-License-Identifier: Apache-2.0
// Layers beside the picture, and their names.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace petzval {

/// Layers beside the picture (AOVs): values at the first surface that a sample sees.
enum class Aov : uint8_t {
    Albedo,
    Normal,
    Depth,
    Position,
    Uv,
    Emission,
    Cost,
    Velocity,
    Ghosts,  ///< light that the lens reflects: of all samples, whatever they see
    Count
};

/// Name and channels of a layer, as they stand in files and on the command line.
struct AovInfo {
    std::string_view name;
    std::array<std::string_view, 3> channels;
    int channel_count;
};
[[nodiscard]] const AovInfo& aov_info(Aov);
[[nodiscard]] std::optional<Aov> aov_from_name(std::string_view);

}  // namespace petzval
