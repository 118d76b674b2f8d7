// SPDX-License-Identifier: Apache-2.0
// Regions of the last surface through which ghosts of small lamps reach the points of a film.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "camera/ghosts/ghost_optics.h"
#include "core/light/small_features.h"

namespace petzval {

/// Rectangle on the last surface, across the axis, that follows the film point and the wavelength
/// in straight lines: light of one lamp, by way of one pair and of one part of the first surface,
/// comes through it. Lengths in mm.
struct GhostRegion {
    uint32_t pair;             ///< in GhostOptics::pairs()
    V2f film_low, film_high;   ///< film points that it is for
    V2f film{0.f}, rear{0.f};  ///< where the middle is, for one film point at line d
    V2f by_x{0.f}, by_y{0.f};  ///< change of the middle by the film point
    V2f by_wave{0.f};          ///< and by wave_of()
    V2f long_axis{1.f, 0.f}, half{0.f};
    float light = 0;  ///< irradiance that it brings to the film, in any unit

    [[nodiscard]] bool serves(V2f film_mm) const {
        return film_mm.x >= film_low.x && film_mm.x <= film_high.x && film_mm.y >= film_low.y &&
               film_mm.y <= film_high.y;
    }
    [[nodiscard]] V2f middle(V2f film_mm, float wave) const {
        const V2f off = film_mm - film;
        return rear + by_x * off.x + by_y * off.y + by_wave * wave;
    }
};

/// Place of a wavelength between 0 at line d and 1 at 400 nm, by its inverse square: so do indices
/// change, nearly (Cauchy 1836).
[[nodiscard]] inline float wave_of(float nm) {
    constexpr float kAtD = 1 / (587.5618f * 587.5618f), kAt400 = 1 / (400.f * 400.f);
    return (1 / (nm * nm) - kAtD) / (kAt400 - kAtD);
}

/// Regions for each part of a film. Whatever they are, a picture keeps its mean: they are places
/// to draw from, each with a density.
class GhostRegions {
  public:
    GhostRegions() = default;
    /// Regions of the lamps among some things, as a camera sees them whose film it is: of the
    /// brightest lamps, those that are small. A function of the arguments alone; no ray is cast
    /// into the scene.
    GhostRegions(const GhostOptics&, std::span<const SmallFeature>);

    [[nodiscard]] bool empty() const { return regions_.empty(); }
    [[nodiscard]] const std::vector<GhostRegion>& regions() const { return regions_; }
    /// Drawn point of the last surface; nothing where no region serves the film point.
    struct Drawn {
        uint32_t pair;
        V2f rear_mm;
    };
    [[nodiscard]] std::optional<Drawn> draw(V2f film_mm, float wave, float pick, V2f u) const;
    /// Density with which draw() gives a point for a pair, 1/mm^2.
    [[nodiscard]] float density(V2f film_mm, float wave, const Drawn&) const;

  private:
    /// Regions of one pair that serve film points of a cell.
    struct Group {
        uint32_t pair;
        float up_to;          ///< share of the cell's light of this pair and those before
        uint32_t first, end;  ///< in members_
    };
    void list_regions();
    [[nodiscard]] std::span<const Group> groups_at(V2f film_mm) const;
    /// Light of the regions of a group that serve a film point.
    [[nodiscard]] float light_of(const Group&, V2f film_mm) const;
    /// Calls f with each cell that a region serves, and the share of the cell.
    template <class F>
    void each_cell(const GhostRegion&, const F&) const;

    V2f film_mm_{0.f};  ///< width and height
    V2i cells_{0, 0};
    std::vector<GhostRegion> regions_;
    std::vector<uint32_t> members_, cells_begin_;  ///< in groups_, row by row, and the end
    std::vector<Group> groups_;
};

}  // namespace petzval
