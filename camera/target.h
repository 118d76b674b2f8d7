// SPDX-License-Identifier: Apache-2.0
// Targets: small bright things that a camera aims rays at, beside those that it draws anyway.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// A flat disc in the scene. It is a window that rays go through, not an object: whatever a ray
/// meets, the picture stays right, and only its noise depends on where targets are.
struct Target {
    V3f centre;                ///< world, metres; a unit direction for what lies at infinity
    V3f normal;                ///< unit; at infinity the direction itself
    float radius_m = 0;        ///< above 0; at infinity the tangent of the angle
    bool at_infinity = false;  ///< a spot of the sky
};

/// Whether camera rays are aimed at targets. Auto: where they pay.
enum class TargetUse : uint8_t { Auto, Off };

/// A target, and the chance that a ray is aimed at it.
struct ListedTarget {
    Target target;
    float chance;  ///< those of a list add up to 1
};

/// Targets of each part of a frame, by a grid of cells.
struct TargetGrid {
    V2i cells{0, 0};
    std::vector<std::vector<ListedTarget>> lists;  ///< row by row

    /// List of the cell of a film point, as FilmPoint has it; beyond the frame, of the nearest.
    [[nodiscard]] std::span<const ListedTarget> at(V2f film) const {
        const auto cell = [](float share, int count) {
            return static_cast<size_t>(
                std::clamp(static_cast<int>(share * static_cast<float>(count)), 0, count - 1));
        };
        return lists[cell(film.y, cells.y) * static_cast<size_t>(cells.x) + cell(film.x, cells.x)];
    }
};

}  // namespace petzval
