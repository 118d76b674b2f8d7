// SPDX-License-Identifier: Apache-2.0
// Draws of far displacements that end in the image of a lamp, most of them along spikes.
#pragma once

#include <array>
#include <optional>

#include "camera/diffraction/edge_runs.h"

namespace petzval::camera {

/// Points of a disc in the plane of spatial frequencies, by directions of a pattern's lobes.
class StarAim {
  public:
    /// Aim at a disc; nothing where it does not lie beyond the pattern's radius, or holds its
    /// middle. The pattern must outlive it.
    [[nodiscard]] static std::optional<StarAim> at(const FarPattern& pattern, V2f middle,
                                                   float disc_radius) {
        const float away = middle.length();
        if (!(away - disc_radius > pattern.radius() && away > 1.05f * disc_radius))
            return std::nullopt;
        return StarAim(pattern, middle, disc_radius);
    }
    /// Share of the far light that falls on the disc, about.
    [[nodiscard]] float share() const { return share_; }
    [[nodiscard]] V2f draw(V2f u) const;
    /// Density of draw() at a point; 0 outside of the disc.
    [[nodiscard]] float density(V2f v) const;

  private:
    StarAim(const FarPattern&, V2f middle, float disc_radius);

    /// Lobe whose spike may cross the disc: from angle to angle about its normal.
    struct Spike {
        float from, to;       ///< radians
        float tanh_half;      ///< of its width there
        float share, passed;  ///< of the draws; of the lobe's light between the angles
        float turned;         ///< angle of the lobe's normal against the disc's middle
    };
    static constexpr size_t kMostSpikes = 4;

    V2f direction_;
    float away_, disc_radius_, half_angle_, evenly_ = 0, share_ = 0;
    std::array<Spike, kMostSpikes> spikes_{};
    size_t count_ = 0;
};

}  // namespace petzval::camera
