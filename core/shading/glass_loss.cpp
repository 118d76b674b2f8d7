// SPDX-License-Identifier: Apache-2.0
#include "core/shading/glass_loss.h"

#include <algorithm>

#include "core/math/trig.h"
#include "core/shading/lobes.h"
#include "core/shading/visible_facets.h"

namespace petzval {
namespace {

constexpr int kLast = kGlassLossCosines - 1;
constexpr size_t kCosines = kGlassLossCosines;

// A way along an axis of the table.
struct Step {
    int first;
    float part;  ///< of the way to the next

    Step(float place, int size)
        : first(std::min(static_cast<int>(place), size - 2)),
          part(place - static_cast<float>(first)) {}
};

// Cosines' squares, of which the mean of what is lost over all directions is an integral.
float square_of_cosine(float place, float knee) {
    return sqr(knee * sqr(place) / (1.f + knee - sqr(place)));
}

// Weights by which the nodes' sum is the mean over all directions: by parts, with Simpson's rule on
// each half of the ways from node to node.
std::array<float, kCosines> weights_of_mean(float knee) {
    constexpr int steps = 4 * kLast;
    std::array<float, steps + 1> square;
    for (int i = 0; i <= steps; ++i)
        square[static_cast<size_t>(i)] = square_of_cosine(static_cast<float>(i) / steps, knee);
    std::array<float, kCosines> weights{};
    for (size_t i = 0; i < kLast; ++i) {
        const float* s = &square[4 * i];
        const float mean = (s[0] + 4.f * s[1] + 2.f * s[2] + 4.f * s[3] + s[4]) / 12.f;
        weights[i] += mean - s[0];
        weights[i + 1] += s[4] - mean;
    }
    return weights;
}

// Directions of one side nearly as the lobe has them, in proportion to cos / (w^2 + cos^2)^(3/2),
// with the width w = 3 alpha. The ends: 1 / sqrt(w^2 + cos^2) at cosine 0 and 1.
struct LostDirections {
    float width, near = 1.f / width, far = 1.f / std::sqrt(sqr(width) + 1.f);

    V3f draw(V2f u) const {
        const float cosine = clamp_unit(safe_sqrt(1.f / sqr(lerp(near, far, u.y)) - sqr(width)));
        const float sine = safe_sqrt(1.f - sqr(cosine));
        const SinCos phi = sincos_turns(u.x);
        return {sine * phi.cosine, sine * phi.sine, cosine};
    }
    float pdf(float cosine) const {  // 1/sr
        const float square = sqr(width) + sqr(cosine);
        return cosine / (2.f * kPi * (near - far) * square * std::sqrt(square));
    }
};

// What facets of glass lose, where a film reflects more or less than Fresnel's formula: facets hide
// more or less of what they reflect than of what they refract.
f4 lost_below_film(f4 lost, const GlassLobe& glass, const SeenFacets& seen) {
    const FewFacets facets = few_visible_facets(seen.wo, seen.alpha, glass.eta[0]);
    for (size_t i = 0; i < FewFacets::kCount; ++i) {
        const float c = facets.cosine[i];
        const f4 bare = of_glass(fresnel_dielectric(c, glass.eta), glass.specular);
        const f4 more = glass.reflectance(c) - bare;
        lost -= more * (facets.reflected[i] - facets.refracted[i]);
    }
    return min(max(lost, f4{}), splat(1.f));
}

}  // namespace

GlassLoss::GlassLoss(float alpha, f4 eta, bool alike, float specular)
    : knee_(kGlassLossKnee * alpha), lanes_(alike ? 1 : 4) {
    for (int i = 0; i < lanes_; ++i)
        lane_[static_cast<size_t>(i)] = lane_of(alpha, eta[i], specular);
}

GlassLoss::Lane GlassLoss::lane_of(float alpha, float eta, float specular) {
    const float f = std::min(safe_sqrt(std::fabs(eta - 1.f) / (eta + 1.f)), kGlassLossMostF);
    const Step index(f / kGlassLossMostF * (kGlassLossIndices - 1), kGlassLossIndices);
    constexpr float least = kGlassLossLeastRoughness;
    const float rough = clamp_unit((std::sqrt(alpha) - least) / (1.f - least));
    const Step roughness(rough * (kGlassLossRoughnesses - 1), kGlassLossRoughnesses);
    Lane lane{};
    for (int corner = 0; corner < 4; ++corner) {
        const int n = index.first + (corner & 1), r = roughness.first + (corner >> 1);
        const float weight = ((corner & 1) ? index.part : 1.f - index.part) *
                             ((corner >> 1) ? roughness.part : 1.f - roughness.part) * 0.001f;
        const float full = weight * specular, plain = weight - full;
        const uint16_t* node = &kGlassLoss[n][r][0][0][0];
        for (size_t i = 0; i < kBoth; ++i) lane.lost[i] += full * static_cast<float>(node[i]);
        if (plain != 0.f)
            for (size_t i = 0; i < kBoth; ++i)
                lane.lost[i] += plain * static_cast<float>(node[kBoth + i]);
        lane.crossing += full * kGlassCrossing[n][r] + plain * 1000.f;
    }
    const auto weights = weights_of_mean(kGlassLossKnee * alpha);
    float low = 0, high = 0;  // what all directions lose on average
    for (size_t i = 0; i < kCosines; ++i) {
        low += weights[i] * lane.lost[i];
        high += weights[i] * lane.lost[kCosines + i];
    }
    // As much etendue goes from the higher index to the lower as the other way.
    lane.dense = eta < 1.f;
    const float ratio = low > 0.f ? sqr(std::max(eta, 1.f / eta)) * high / low : 0.f;
    const float there = std::min(lane.crossing, ratio);
    if (lane.dense) {
        lane.crossing = ratio > 0.f ? there / ratio : 0.f;
        std::swap(low, high);
    } else {
        lane.crossing = there;
    }
    lane.per_loss = {low > 0.f ? kInvPi * (1.f - lane.crossing) / low : 0.f,
                     high > 0.f ? kInvPi * lane.crossing / high : 0.f};
    return lane;
}

f4 GlassLoss::crossing() const {
    f4 shares = splat(lane_[0].crossing);
    for (int i = 1; i < lanes_; ++i) shares[i] = lane_[static_cast<size_t>(i)].crossing;
    return shares;
}

f4 GlassLoss::lost(float cosine, bool behind) const {
    const float place = std::sqrt(clamp_unit(cosine * (1.f + knee_) / (cosine + knee_))) * kLast;
    const Step step(place, kGlassLossCosines);
    f4 shares{};
    for (int i = 0; i < lanes_; ++i) {
        const Lane& lane = lane_[static_cast<size_t>(i)];
        const float* row = &lane.lost[(lane.dense != behind ? kCosines : 0) + size_t(step.first)];
        shares[i] = lerp(row[0], row[1], step.part);
    }
    return lanes_ == 1 ? splat(shares[0]) : shares;
}

f4 GlassLoss::lobe(float cosine, bool behind) const {
    f4 per_loss = splat(lane_[0].per_loss[behind]);
    for (int i = 1; i < lanes_; ++i) per_loss[i] = lane_[static_cast<size_t>(i)].per_loss[behind];
    return per_loss * lost(cosine, behind) * cosine;
}

void LostLobe::split_from(GlassLobe& glass, const SeenFacets& seen) {
    // Without a difference in index all normals would share one direction.
    f4& eta = glass.eta;
    eta = eta > 0.999f && eta < 1.001f ? splat(1.001f) : eta;
    loss = GlassLoss(seen.alpha.x, eta, !glass.disperses, glass.specular);
    f4 lost = loss.lost(seen.wo.z, false);
    for (int i = 0; i < 4 && seen.alpha.anisotropic(); ++i)
        lost[i] = i > 0 && !glass.disperses
                      ? lost[0]
                      : visible_glass_loss(seen.wo, seen.alpha, eta[i], glass.specular);
    if (glass.film_share > 0.f) lost = lost_below_film(lost, glass, seen);
    lost = zero_off(glass.on, lost);
    const float all = hsum(glass.carried * lost);
    crossing = all > 0.f ? hsum(glass.carried * lost * loss.crossing()) / all : 0.f;
    const float part = std::min(all, 0.95f);  // single scattering has its samples too
    chance = glass.chance * part;
    glass.chance *= 1.f - part;
    weight = glass.weight * lost;
    tint = glass.tint;
}

BsdfValue LostLobe::value(const SeenFacets& seen, const V3f& wi) const {
    const bool behind = wi.z < 0.f;
    const float cosine = std::fabs(wi.z), side = behind ? crossing : 1.f - crossing;
    const f4 scattered = weight * loss.lobe(cosine, behind);
    return {behind ? tint * scattered : scattered,
            chance * side * LostDirections{3.f * seen.alpha.x}.pdf(cosine)};
}

std::optional<BsdfSample> LostLobe::draw(const SeenFacets& seen, const BsdfNumbers& u) const {
    const V3f wi = unit(LostDirections{3.f * seen.alpha.x}.draw(u.direction));
    return BsdfSample::wide(u.lobe / chance < crossing ? mirror_below(wi) : wi);
}

}  // namespace petzval
