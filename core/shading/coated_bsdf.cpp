// SPDX-License-Identifier: Apache-2.0
#include "core/shading/coated_bsdf.h"

#include "core/scene/material.h"

namespace petzval {

void CoatedBsdf::add_coat(const CoatInput& coat, const Bands& bands, const V3f& wo, f4 throughput,
                          const V3f& up) {
    const Frame frame = coat.normal == V3f(0, 0, 1) ? Frame{} : Frame::about(coat.normal);
    BsdfInput in;
    in.roughness = coat.roughness;
    in.dielectric_f0 = uniform(kCoatF0, bands);
    const Bsdf lobe(in, bands, frame.to_local(wo), throughput, frame.to_local(up));
    // All lanes reflect alike: any one that is on tells how much that is.
    const float reflected = coat.weight * hmax(lobe.albedo()), under = 1.f - reflected;
    const f4 share = zero_off(bands.on, throughput);
    const float below = under * hsum(share * base_.albedo()) / hsum(share);
    coat_.emplace(Coat{frame, lobe, coat.weight, under, reflected / (reflected + below)});
}

StraightThrough CoatedBsdf::straight_through() const {
    StraightThrough out = base_.straight_through();
    if (!coat_) return out;
    out.value *= coat_->under;
    out.chance *= 1.f - coat_->chance;
    return out;
}

f4 CoatedBsdf::albedo() const {
    if (!coat_) return base_.albedo();
    return coat_->lobe.albedo() * coat_->weight + base_.albedo() * coat_->under;
}

BsdfValue CoatedBsdf::eval_coated(const V3f& wi) const {
    const BsdfValue coat = coat_->lobe.eval(coat_->frame.to_local(wi)), base = base_.eval(wi);
    return {coat.f_cos * coat_->weight + base.f_cos * coat_->under,
            coat.pdf * coat_->chance + base.pdf * (1.f - coat_->chance)};
}

std::optional<BsdfSample> CoatedBsdf::sample_coated(BsdfNumbers u) const {
    const bool from_coat = u.lobe < coat_->chance;
    const float chance = from_coat ? coat_->chance : 1.f - coat_->chance;
    const float left = std::min((from_coat ? u.lobe : u.lobe - coat_->chance) / chance, kOneMinus);
    std::optional<BsdfSample> drawn =
        (from_coat ? coat_->lobe : base_).sample(left, u.direction, u.hero_decided);
    if (!drawn) return drawn;
    if (from_coat) drawn->wi = coat_->frame.to_world(drawn->wi);
    if (drawn->delta)
        drawn->weight *= (from_coat ? coat_->weight : coat_->under) / chance;
    else if (!drawn->weigh(eval_coated(drawn->wi)))
        drawn.reset();
    return drawn;
}

}  // namespace petzval
