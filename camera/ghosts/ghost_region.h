// SPDX-License-Identifier: Apache-2.0
// Region of the last surface through which light of a ghost reaches the points of a film.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/math.h"

namespace petzval::camera {

/// Place of a wavelength between 0 at line d and 1 at 400 nm, by its inverse square: so do indices
/// change, nearly (Cauchy 1836).
[[nodiscard]] inline float wave_of(float nm) {
    constexpr float kAtD = 1 / (587.5618f * 587.5618f), kAt400 = 1 / (400.f * 400.f);
    return (1 / (nm * nm) - kAtD) / (kAt400 - kAtD);
}

/// A pair of GhostOptics::pairs(), by number, and a point beside the axis on the last surface.
struct GhostDraw {
    uint32_t pair;
    V2f rear_mm;
};

/// Rectangle on the last surface, across the axis, that follows the film point and the wavelength
/// in straight lines: some of the light of a ghost comes through it. Lengths in mm.
struct GhostRegion {
    uint32_t pair;                      ///< in GhostOptics::pairs()
    V2f film_low{0.f}, film_high{0.f};  ///< film points that it is for
    V2f film{0.f}, rear{0.f};           ///< where the middle is, for one film point at line d
    V2f by_x{0.f}, by_y{0.f};           ///< change of the middle by the film point
    V2f by_wave{0.f};                   ///< and by wave_of()
    V2f long_axis{1.f, 0.f}, half{0.f};
    float light = 0;  ///< irradiance that it brings to the film, in any unit

    [[nodiscard]] bool serves(V2f film_mm) const {
        return film_mm.x >= film_low.x && film_mm.x <= film_high.x && film_mm.y >= film_low.y &&
               film_mm.y <= film_high.y;
    }
    /// A point of the rectangle, so many times as long and as wide; u in [0, 1)^2.
    [[nodiscard]] V2f at(V2f film_mm, float wave, V2f u, float times = 1) const {
        const V2f off = (u * 2.f - V2f(1)) * half * times;
        return middle(film_mm, wave) + long_axis * off.x + short_axis() * off.y;
    }
    [[nodiscard]] bool contains(V2f film_mm, float wave, V2f rear_mm, float times = 1) const {
        const V2f off = rear_mm - middle(film_mm, wave);
        return std::fabs(off.dot(long_axis)) <= times * half.x &&
               std::fabs(off.dot(short_axis())) <= times * half.y;
    }
    [[nodiscard]] float area_mm2() const { return 4 * half.x * half.y; }

  private:
    [[nodiscard]] V2f short_axis() const { return {-long_axis.y, long_axis.x}; }
    [[nodiscard]] V2f middle(V2f film_mm, float wave) const {
        const V2f off = film_mm - film;
        return rear + by_x * off.x + by_y * off.y + by_wave * wave;
    }
};

/// A ray that reached the film's plane.
struct GhostRecord {
    V2d film_mm, rear_mm;
    V2d in_disc;  ///< place on what it came from or went through, of radius 1: a lamp, the iris
    double wave = 0;
    double light_mm2 = 0;  ///< that comes with it; 0 where something stops it, or the film ends
};
/// Least number of rays that tell a region.
inline constexpr size_t kLeastRecords = 9;
/// Share of a region's points that see the disc, from which on it is good.
inline constexpr double kSeesEnough = 0.15;

/// A region of rays, and shares about: of its points that see the disc, and of the rays that bring
/// light.
struct StraightRegion {
    GhostRegion region{};
    double sees = 0, open = 0;
};
/// The region of rays to all points of a disc, by least squares: where they cross the last surface,
/// as it changes with the film point, the point of the disc and the wavelength, and what errors are
/// left. kLeastRecords at least.
[[nodiscard]] StraightRegion straight_region(const std::vector<GhostRecord>&);

}  // namespace petzval::camera
