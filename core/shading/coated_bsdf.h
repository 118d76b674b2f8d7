// SPDX-License-Identifier: Apache-2.0
// BSDF of a surface that may have a clear coat, as KHR_materials_clearcoat has it.
#pragma once

#include <optional>

#include "core/shading/bsdf.h"

namespace petzval {

/// Clear coat at a point: a dielectric layer of index 1.5, which takes nothing.
struct CoatInput {
    float weight = 0;  ///< how much of the surface has it; 0: none
    float roughness = 0;
    V3f normal{0, 0, 1};  ///< unit, in the shading frame, on wo's side
};

/// Coat over a Bsdf. The coat is a GGX reflection about a normal of its own. What lies below gets
/// what the coat does not send back towards wo, over all directions: that is how the extension
/// mixes, so nothing is lost or gained in a white furnace. Each lobe is reciprocal; the mixture is
/// not, by the ratio of what the coat lets through for wo and for wi. Directions are as in Bsdf.
class CoatedBsdf {
  public:
    CoatedBsdf(const BsdfInput& in, const CoatInput& coat, const Bands& bands, const V3f& wo,
               f4 throughput = splat(1.f), const V3f& up = V3f(0, 0, 1))
        : base_(in, bands, wo, throughput, up) {
        if (coat.weight > 0.f) add_coat(coat, bands, wo, throughput, up);
    }

    [[nodiscard]] BsdfValue eval(const V3f& wi) const {
        return coat_ ? eval_coated(wi) : base_.eval(wi);
    }
    [[nodiscard]] std::optional<BsdfSample> sample(float u_lobe, V2f u,
                                                   bool hero_decided = true) const {
        return coat_ ? sample_coated({u_lobe, u, hero_decided})
                     : base_.sample(u_lobe, u, hero_decided);
    }
    [[nodiscard]] bool has_wide_lobe() const {
        return base_.has_wide_lobe() || (coat_ && coat_->lobe.has_wide_lobe());
    }
    [[nodiscard]] bool is_clear() const { return base_.is_clear(); }
    [[nodiscard]] StraightThrough straight_through() const;
    [[nodiscard]] f4 albedo() const;

  private:
    struct Coat {
        Frame frame;  ///< in the shading frame
        Bsdf lobe;
        float weight;
        float under;   ///< share that the base gets
        float chance;  ///< that the coat is drawn
    };
    void add_coat(const CoatInput&, const Bands&, const V3f& wo, f4 throughput, const V3f& up);
    [[nodiscard]] BsdfValue eval_coated(const V3f& wi) const;
    [[nodiscard]] std::optional<BsdfSample> sample_coated(BsdfNumbers) const;

    Bsdf base_;
    std::optional<Coat> coat_;
};

}  // namespace petzval
