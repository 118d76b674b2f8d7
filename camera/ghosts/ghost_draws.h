// SPDX-License-Identifier: Apache-2.0
// Draws of the ghosts of a film point: which pair reflects, and where on the last surface.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "camera/ghosts/ghost_pupils.h"
#include "camera/ghosts/ghost_regions.h"
#include "core/sampling/sampler.h"

namespace petzval::camera {

/// Points that samples draw: over all of the last surface, mostly where the iris is seen, for the
/// pairs that are bright in an even scene or by the lamps; and through the regions of lamps.
class GhostDraws {
  public:
    GhostDraws(GhostOptics, GhostRegions, const RunTasks& = one_by_one);
    GhostDraws(const GhostDraws&) = delete;
    GhostDraws& operator=(const GhostDraws&) = delete;

    /// Whether they are, for the same lamps, those of another camera too, to the bit: it has the
    /// same rays, and its lens the same coating.
    [[nodiscard]] bool are_of(const GhostOptics&) const;

    /// Draws of one sample: over all, and through a region. Few samples have any.
    struct OfSample {
        std::optional<GhostDraw> over_all, through_region;
    };
    /// wave: that of the hero lane.
    [[nodiscard]] OfSample draw(V2f film_mm, float wave, const Sampler&) const;
    /// Draws of a sample per mm^2 at a point for its pair, of both kinds, each of the waves equally
    /// likely to be the hero's; above 0 on all of the last surface.
    [[nodiscard]] float density(V2f film_mm, std::span<const float> waves, const GhostDraw&) const;

  private:
    GhostOptics optics_;
    GhostPupils pupils_;
    GhostRegions regions_;
};

}  // namespace petzval::camera
