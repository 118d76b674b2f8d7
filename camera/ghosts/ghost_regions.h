// SPDX-License-Identifier: Apache-2.0
// Regions of the last surface through which ghosts of small lamps reach the points of a film.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "camera/ghosts/ghost_optics.h"
#include "camera/ghosts/ghost_region.h"
#include "camera/run_tasks.h"
#include "core/light/small_features.h"

namespace petzval::camera {

struct GhostLamp;

/// Regions for each part of a film. Whatever they are, a picture keeps its mean: they are places
/// to draw from, each with a density.
class GhostRegions {
  public:
    GhostRegions() = default;
    /// Regions of the lamps among some things, as a camera sees them whose film it is: of the
    /// brightest lamps, those that are small. A function of the arguments alone, whatever runs its
    /// parts; no ray is cast into the scene.
    GhostRegions(const GhostOptics&, std::span<const SmallFeature>, const RunTasks& = one_by_one);

    /// Whether there are regions for film points about this one.
    [[nodiscard]] bool serve(V2f film_mm) const { return !groups_at(film_mm).empty(); }
    /// Drawn pair, by the light of its regions there; pick in [0, 1). And the chance of each.
    [[nodiscard]] uint32_t pair(V2f film_mm, float pick) const;
    [[nodiscard]] float chance(V2f film_mm, uint32_t pair) const;
    /// Drawn pair and point of the last surface; nothing where no region serves the film point.
    [[nodiscard]] std::optional<GhostDraw> draw(V2f film_mm, float wave, float pick, V2f u) const;
    /// Density with which draw() gives a point for a pair, 1/mm^2.
    [[nodiscard]] float density(V2f film_mm, float wave, const GhostDraw&) const;

  private:
    /// Regions of one pair that serve film points of a cell.
    struct Group {
        uint32_t pair;
        float up_to;          ///< share of the cell's light of this pair and those before
        uint32_t first, end;  ///< in members_
    };
    void search(const GhostOptics&, std::span<const GhostLamp>, const RunTasks&);
    void list_regions(const RunTasks&);
    [[nodiscard]] std::span<const Group> groups_at(V2f film_mm) const;
    /// Group that a number in [0, 1) picks; it becomes one within the group.
    [[nodiscard]] static const Group& picked(std::span<const Group>, float& pick);
    /// Group of a pair and its chance; nullptr: none there.
    [[nodiscard]] static std::pair<const Group*, float> group_of(std::span<const Group>,
                                                                 uint32_t pair);
    /// Regions of a group that serve a film point: their light, and the chance of each.
    struct Serving {
        float light = 0, count = 0;
        [[nodiscard]] float chance(const GhostRegion&) const;
    };
    [[nodiscard]] Serving serving(const Group&, V2f film_mm) const;
    /// Calls f with each cell that a region serves, and the share of the cell.
    template <class F>
    void each_cell(const GhostRegion&, const F&) const;

    V2f film_mm_{0.f};  ///< width and height
    V2i cells_{0, 0};
    std::vector<GhostRegion> regions_;
    std::vector<uint32_t> members_, cells_begin_;  ///< in groups_, row by row, and the end
    std::vector<Group> groups_;
};

}  // namespace petzval::camera
