// SPDX-License-Identifier: Apache-2.0
// Bounds of the part of the stop through which a film point sees the scene: what rims leave of it,
// a cat's eye towards the corners of the film.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/math/lanes.h"
#include "core/math/math.h"

namespace petzval::camera {

/// A part of the plane of the stop in rows across an axis of symmetry. Millimetres, in a frame
/// whose +y axis points the way that the film point lies from the lens's axis.
class StopBounds {
  public:
    static constexpr int kRows = 32;

    /// Rows over y in [-reach_mm, reach_mm], each with all x up to its half width; not all 0.
    StopBounds(float reach_mm, const std::array<float, kRows>& half_width_mm);

    [[nodiscard]] float area_mm2() const { return area_; }
    /// Point that is uniform in the bounds; u in [0, 1)^2. Neighbours stay neighbours.
    [[nodiscard]] V2f sample(V2f u) const;
    [[nodiscard]] bool contain(V2f point_mm) const;

  private:
    float reach_, area_ = 0;
    std::array<float, kRows> half_width_;
    std::array<float, kRows + 1> area_below_{};  ///< mm2 below each row
};

/// Bounds by height on the film, for a lens that is symmetric about its axis.
class StopBoundsByHeight {
  public:
    /// Whether the rays from a film point at this height (mm, on the +y axis) through points of the
    /// stop pass all rims, lane by lane.
    using Passes = std::function<m8(float height_mm, f8 stop_x_mm, f8 stop_y_mm)>;

    /// No bounds at any height.
    StopBoundsByHeight() = default;
    /// Bounds for heights up to film_reach_mm of what passes of a disk of stop_reach_mm, where they
    /// have less than area_mm2. What is open between the points that are tested is taken to be an
    /// interval about the axis of symmetry; draws must not rely on that.
    StopBoundsByHeight(const Passes&, float film_reach_mm, float stop_reach_mm, double area_mm2);

    /// Bounds at a height; nullptr where there are none that help.
    [[nodiscard]] const StopBounds* at(float height_mm) const;

  private:
    float rings_per_mm_ = 0;
    std::vector<std::optional<StopBounds>> rings_;
};

}  // namespace petzval::camera
