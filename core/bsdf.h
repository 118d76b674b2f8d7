// SPDX-License-Identifier: Apache-2.0
// How a glTF surface scatters light: one GGX reflection over a diffuse, thin or glass body.
#pragma once

#include <optional>

#include "core/math.h"
#include "core/spectrum.h"

namespace petzval {

/// The numbers of a material at a point, textures applied. Shares of light are per lane.
struct BsdfInput {
    f4 base_color{};
    float metallic = 0, roughness = 1;
    f4 dielectric_f0{};        ///< reflectance at normal incidence, KHR_materials_specular included
    float dielectric_f90 = 1;  ///< at grazing incidence
    float transmission = 0;
    float eta = 1.5f;  ///< index on the far side over index on wo's side
    bool thin = true;  ///< transmission without a volume: nothing bends
};

/// f cos and density together; both 0 where only a delta lobe could answer.
struct BsdfValue {
    f4 f_cos{};
    float pdf = 0;  ///< 1/sr
};

struct BsdfSample {
    V3f wi;
    f4 weight;  ///< f cos / pdf
    float pdf;  ///< 1/sr; meaningless for a delta lobe
    bool delta;
    bool transmitted;  ///< wi lies on the other side
};

/// Directions point away from the surface, in the shading frame turned to wo's side (wo.z > 0).
/// Paths carry basic radiance L / n^2 (Nicodemus 1963), so refraction scales nothing and no
/// weight's mean exceeds 1.
class Bsdf {
  public:
    Bsdf(const BsdfInput&, const Bands&, const V3f& wo);

    [[nodiscard]] BsdfValue eval(const V3f& wi) const;
    /// u_lobe picks the lobe, u the direction. Nothing where the drawn direction is absorbed.
    [[nodiscard]] std::optional<BsdfSample> sample(float u_lobe, V2f u) const;
    /// Some lobe is wide enough for light sampling to help.
    [[nodiscard]] bool has_wide_lobe() const { return p_diffuse_ > 0 || !delta_; }
    /// Share of light that is scattered, all lobes together (glass: as if it lost nothing).
    [[nodiscard]] f4 albedo() const;

  private:
    [[nodiscard]] float pdf_of_normal(float wo_m, float d) const;
    void add_glass(const V3f& wi, BsdfValue&) const;
    [[nodiscard]] float glass_reflectance(float wo_m) const;
    [[nodiscard]] std::optional<BsdfSample> sample_delta(float u_lobe) const;
    [[nodiscard]] std::optional<V3f> draw(float u_lobe, V2f u) const;

    V3f wo_;
    float alpha_, eta_;
    bool delta_;
    float lambda_o_;
    // Reflection: single-scatter GGX times spec0 (1 - s) + spec90 s, multiple scattering included.
    f4 spec0_, spec90_;
    float albedo_f0_, albedo_f90_;  ///< GGX's own, for wo
    f4 diffuse_;                    ///< albedo
    f4 thin_;                       ///< albedo of straight transmission
    f4 glass_;                      ///< tint of refracted light; its untinted share is glass_share_
    float glass_share_, glass_specular_;
    float p_spec_, p_diffuse_, p_thin_, p_glass_;
    m4 on_;
};

}  // namespace petzval
