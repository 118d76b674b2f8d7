// SPDX-License-Identifier: Apache-2.0
// Multiple scattering of rough glass: how much light, and where it goes.
#pragma once

#include <array>

#include "core/math/lanes.h"
#include "core/math/math.h"
#include "core/shading/glass_loss_table.h"

namespace petzval {

/// Light that single scattering at a rough boundary of glass loses, sent on as a lobe that is wide
/// on both sides. Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks": of
/// what arrives at a cosine with the single-scatter albedo E, 1 - E is lost, and it goes into the
/// directions in proportion to their own (1 - E) cos. Here each side has its E, and directions are
/// weighed by the etendue n^2 cos dw, so the lobe is reciprocal and holds all that is lost.
///
/// How much changes sides is free between these two laws. It is the share of single scattering
/// from the side of the lower index, on average over the directions, which is nearly the share of
/// multiple scattering in a random walk on the microsurface (Heitz et al. 2016,
/// "Multiple-Scattering Microfacet BSDFs with the Smith Model").
class GlassLoss {
  public:
    GlassLoss() {}  // NOLINT(modernize-use-equals-default): nothing is set, which costs nothing
    /// For a GGX width and each lane's index behind over that in front; only the first of these
    /// where the lanes are all alike. specular: factor on Fresnel's reflectance.
    GlassLoss(float alpha, f4 eta, bool alike, float specular);

    /// Share of the light that is lost, at a cosine > 0 in front or behind. At specular 1, indices
    /// from 1.1 to 2.4 and cosines from 0.01 on it is off by -0.0095 to 0.003.
    [[nodiscard]] f4 lost(float cosine, bool behind) const;
    /// Share that goes on behind of what is lost in front.
    [[nodiscard]] f4 crossing() const;
    /// Density of the directions that it leaves in, 1/sr; the integral over both sides is 1.
    [[nodiscard]] f4 lobe(float cosine, bool behind) const;

  private:
    static constexpr int kBoth = 2 * kGlassLossCosines;
    struct Lane {
        std::array<float, kBoth> lost;  ///< on the side of the lower index, then of the higher
        float crossing;
        std::array<float, 2> per_loss;  ///< lobe / (cos lost), in front and behind
        bool dense;                     ///< the higher index is in front
    };
    [[nodiscard]] static Lane lane_of(float alpha, float eta, float specular);

    float knee_;
    int lanes_;  ///< 1 where all are alike
    std::array<Lane, 4> lane_;
};

}  // namespace petzval
