// SPDX-License-Identifier: Apache-2.0
// Sheen of cloth: fibres that stand up and scatter at grazing angles, as KHR_materials_sheen has
// it.
#pragma once

#include "core/math/math.h"

namespace petzval {

/// Smallest roughness of a sheen: below it the lobe is a spike at grazing angles, which holds no
/// light.
inline constexpr float kSmallestSheenRoughness = 0.07f;

/// Sheen lobe of the colour white. Estevez and Kulla 2017, "Production Friendly Microfacet Sheen
/// BRDF": equation 2 for the density of normals, equations 3 and 4 for the shadowing, with the
/// width alpha = roughness^2 that glTF asks for. Where this would send back more than what arrives
/// (smooth sheens at grazing angles, up to twice as much), it is scaled down to that.
class Sheen {
  public:
    Sheen() {}  // NOLINT(modernize-use-equals-default): nothing is set, which costs nothing
    /// roughness: 0 to 1. cosine: of wo, > 0.
    Sheen(float roughness, float cosine);

    /// Share of the light from wo that is scattered, 0 to 1.
    [[nodiscard]] float albedo() const { return albedo_; }
    /// Value of the BRDF times the cosine of wi; both unit, on the upper side.
    [[nodiscard]] float f_cos(const V3f& wo, const V3f& wi) const;

  private:
    [[nodiscard]] float curve(float x) const;
    [[nodiscard]] float lambda(float cosine) const;

    float per_alpha_, curve_[5], at_half_, lambda_o_, albedo_, scale_;
};

}  // namespace petzval
