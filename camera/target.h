// SPDX-License-Identifier: Apache-2.0
// Targets: small bright things that a camera aims rays at, beside those that it draws anyway.
#pragma once

#include <cstdint>
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

/// A target, and the chance that a ray is aimed at it.
struct ListedTarget {
    Target target;
    float chance;  ///< those of a list add up to 1
};

/// Targets of each part of a frame, by square cells of its pixels.
struct TargetGrid {
    static constexpr int kCell_px = 16;
    V2i cells{0, 0};
    std::vector<std::vector<ListedTarget>> lists;  ///< row by row

    /// List of a pixel's cell, of the full frame.
    [[nodiscard]] const std::vector<ListedTarget>& at(int x, int y) const {
        return lists[static_cast<size_t>(y / kCell_px) * static_cast<size_t>(cells.x) +
                     static_cast<size_t>(x / kCell_px)];
    }
};

}  // namespace petzval
