// SPDX-License-Identifier: Apache-2.0
// Targets: small bright things that a camera sends rays to, beside those that it draws anyway.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "camera/film_cell.h"
#include "camera/pose.h"
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

/// Target in the space of a camera, in metres, with two axes in its plane.
struct LocalTarget {
    V3d centre, normal;
    double radius_m;
    bool at_infinity;
    V3d across, up;  ///< unit, at right angles to each other and to the normal

    LocalTarget(const V3d& centre, const V3d& normal, double radius_m, bool at_infinity);
    LocalTarget(const Pose& pose, const Target& t)
        : LocalTarget(pose.local(t.at_infinity ? t.centre : t.centre - pose.origin),
                      pose.local(t.normal), double(t.radius_m), t.at_infinity) {}
};

/// A known ray of a lens to the middle of a target, and how it changes: where the search for rays
/// nearby starts. Direction cosines at the film.
struct TargetStart {
    V2f film_mm{0.f}, cosines{0.f};
    V2f by_film_x{0.f}, by_film_y{0.f};  ///< for a millimetre on the film
    V2f by_across{0.f}, by_up{0.f};      ///< for a radius on the target
};

/// A target in the space of a camera, with what is known of the ways to it from the whole film.
struct PreparedTarget {
    LocalTarget target;
    V2f place;                          ///< film point at which the middle of the stop pictures it
    std::vector<TargetStart> starts{};  ///< of a traced lens
};

/// A target that is ready for the film points of a cell, and the chance that a ray is sent to it.
struct ListedTarget {
    static constexpr size_t kMostStarts = 8;

    LocalTarget target;
    float chance;  ///< those of a list add up to 1
    float met;     ///< share of ordinary rays that pass it, about
    V2f place;     ///< of the cell, from which it is seen, or nearly
    /// Of a traced lens: one for each way on which rays get there, as far as they are known.
    std::array<TargetStart, kMostStarts> starts{};
    uint8_t start_count = 0;
    uint32_t number = 0;  ///< in TargetGrid::targets
};

using TargetList = std::span<const ListedTarget>;

/// Number of the target that is picked from a list, not empty, by its chance; u in [0, 1).
[[nodiscard]] inline size_t picked(TargetList targets, float u) {
    size_t i = 0;
    while (i + 1 < targets.size() && u >= targets[i].chance) u -= targets[i++].chance;
    return i;
}

/// Targets of each part of a frame, by a grid of cells.
struct TargetGrid {
    V2i cells{0, 0};
    std::vector<std::vector<ListedTarget>> lists;  ///< row by row
    std::vector<Target> targets;                   ///< all of them, in the world

    /// A cell of a frame.
    [[nodiscard]] FilmCell cell(int i, int j, V2i size_px) const {
        const V2i first(size_px.x * i / cells.x, size_px.y * j / cells.y),
            last(size_px.x * (i + 1) / cells.x, size_px.y * (j + 1) / cells.y);
        return {V2f(first) / V2f(size_px), V2f(last) / V2f(size_px)};
    }
    /// List of the cell of a film point, as FilmPoint has it; beyond the frame, of the nearest.
    [[nodiscard]] TargetList at(V2f film) const {
        const auto cell = [](float share, int count) {
            return static_cast<size_t>(
                std::clamp(static_cast<int>(share * static_cast<float>(count)), 0, count - 1));
        };
        return lists[cell(film.y, cells.y) * static_cast<size_t>(cells.x) + cell(film.x, cells.x)];
    }
};

inline LocalTarget::LocalTarget(const V3d& c, const V3d& n, double radius, bool infinite)
    : centre(c), normal(n), radius_m(radius), at_infinity(infinite) {
    const V3d axis = std::abs(normal.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    across = axis.cross(normal).normalized();
    up = normal.cross(across);
}

}  // namespace petzval
