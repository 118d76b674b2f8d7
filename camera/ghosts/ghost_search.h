// SPDX-License-Identifier: Apache-2.0
// Search for the ways on which a lamp's ghosts reach the film: rays from the lamp through the lens.
#pragma once

#include <array>
#include <vector>

#include "camera/ghosts/ghost_regions.h"

namespace petzval::camera {

/// A lamp in the lens's space, z from the first vertex.
struct GhostLamp {
    V3d centre_mm;     ///< at infinity: the unit direction to it
    double radius_mm;  ///< at infinity: the tangent of its angle
    bool at_infinity;
    double nits_sr;  ///< luminance times solid angle, as the lens sees it
};

/// Eight rays of a lamp through a part of the first surface.
struct LampDraws {
    std::array<V2d, 8> in_part, on_lamp;  ///< of the unit square, and of the unit disc
    f8 nm;
    LensIndices<f8> indices;
};

/// Search for the regions of lamps.
class GhostSearch {
  public:
    /// The optics must outlive it.
    explicit GhostSearch(const GhostOptics&);

    /// What was found, and the number of parts of the first surface that were looked at for it.
    struct Found {
        std::vector<GhostRegion> regions;
        int parts = 0;
    };
    /// The regions of a lamp's ghosts by one pair: one for each part of the first surface whose
    /// light reaches the film, and a few beside them. After most_parts none is divided: where fewer
    /// were looked at, any larger number finds the same.
    [[nodiscard]] Found find(uint32_t pair, const GhostLamp&, int most_parts) const;

  private:
    const GhostOptics& optics_;
    std::vector<LampDraws> draws_;
};

}  // namespace petzval::camera
