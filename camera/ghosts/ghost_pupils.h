// SPDX-License-Identifier: Apache-2.0
// Pupils of the ghosts of a lens: draws of rays that bring the light of an even scene.
#pragma once

#include <vector>

#include "camera/ghosts/ghost_optics.h"
#include "camera/ghosts/ghost_region.h"
#include "camera/run_tasks.h"

namespace petzval::camera {

class GhostPupils {
  public:
    /// The optics must outlive it. For each pair, rays with a fixed seed tell where those that pass
    /// the iris cross the last surface, and how much light they bring.
    explicit GhostPupils(const GhostOptics&, const RunTasks& = one_by_one);

    /// Drawn pair, by its light; pick in [0, 1). And the chance of each.
    [[nodiscard]] uint32_t pair(float pick) const;
    [[nodiscard]] float chance(uint32_t pair) const { return chances_[pair]; }
    /// Drawn point of the last surface for a pair: anywhere, and mostly where the film point sees
    /// the iris. u in [0, 1)^2.
    [[nodiscard]] V2f point_mm(uint32_t pair, V2f film_mm, V2f u) const;
    /// Density of a point for its pair, 1/mm^2; above 0 on all of the last surface.
    [[nodiscard]] float density(V2f film_mm, const GhostDraw&) const;

  private:
    /// Cells of the film each way, in which straight lines hold better than over the whole.
    static constexpr int kAcross = 4, kDown = 3, kCells = kAcross * kDown;
    [[nodiscard]] static int cell_of(V2f film);
    /// Film point of a cell; u in [0, 1)^2.
    [[nodiscard]] V2f film_mm(int cell, V2f u) const;
    [[nodiscard]] GhostRegion region_of(GhostPair, int cell) const;
    [[nodiscard]] GhostRegion region_at(GhostPair, int cell, int crossing) const;
    [[nodiscard]] std::vector<GhostRecord> crossings(GhostPair, int cell, int crossing,
                                                     const GhostRegion&) const;
    [[nodiscard]] float light_of(uint32_t pair) const;
    [[nodiscard]] const GhostRegion& region(uint32_t pair, V2f film_mm) const;

    const GhostOptics& optics_;
    LensIndices<f8> line_d_;
    std::vector<GhostRegion> regions_;    ///< cell by cell for each pair
    std::vector<float> chances_, up_to_;  ///< of each pair; and the sum of those up to it
};

}  // namespace petzval::camera
