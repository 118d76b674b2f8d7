// SPDX-License-Identifier: Apache-2.0
#include "core/shading/glass_loss.h"

#include <algorithm>

#include "core/math/trig.h"

namespace petzval {
namespace {

constexpr int kLast = kGlassLossCosines - 1;
using Row = std::array<float, kGlassLossCosines>;
using Node = uint16_t[2][2][kGlassLossCosines];

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
Row weights_of_mean(float knee) {
    constexpr int steps = 4 * kLast;
    std::array<float, steps + 1> square;
    for (int i = 0; i <= steps; ++i)
        square[static_cast<size_t>(i)] = square_of_cosine(static_cast<float>(i) / steps, knee);
    Row weights{};
    for (size_t i = 0; i < kLast; ++i) {
        const float* s = &square[4 * i];
        const float mean = (s[0] + 4.f * s[1] + 2.f * s[2] + 4.f * s[3] + s[4]) / 12.f;
        weights[i] += mean - s[0];
        weights[i + 1] += s[4] - mean;
    }
    return weights;
}

float mean_of(const Row& lost, const Row& weights) {
    float mean = 0;
    for (size_t i = 0; i < lost.size(); ++i) mean += weights[i] * lost[i];
    return mean;
}

}  // namespace

GlassLoss::GlassLoss(float alpha, f4 eta, bool alike, float specular)
    : knee_(kGlassLossKnee * alpha) {
    const Row weights = weights_of_mean(knee_);
    set_lane(0, alpha, eta[0], specular, weights);
    if (!alike) {
        for (int i = 1; i < 4; ++i) set_lane(i, alpha, eta[i], specular, weights);
        return;
    }
    for (size_t side = 0; side < 2; ++side) {
        for (f4& lost : lost_[side]) lost = splat(lost[0]);
        per_loss_[side] = splat(per_loss_[side][0]);
    }
    crossing_ = splat(crossing_[0]);
}

void GlassLoss::set_lane(int lane, float alpha, float eta, float specular, const Row& weights) {
    const float f = std::min(safe_sqrt(std::fabs(eta - 1.f) / (eta + 1.f)) , kGlassLossMostF);
    const Step index(f / kGlassLossMostF * (kGlassLossIndices - 1), kGlassLossIndices);
    constexpr float least = kGlassLossLeastRoughness;
    const float rough = clamp_unit((std::sqrt(alpha) - least) / (1.f - least));
    const Step roughness(rough * (kGlassLossRoughnesses - 1), kGlassLossRoughnesses);
    std::array<Row, 2> lost{};  // on the side of the lower index, and of the higher
    float crossing = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const int n = corner & 1, r = corner >> 1;
        const float weight =
            (n ? index.part : 1.f - index.part) * (r ? roughness.part : 1.f - roughness.part);
        const Node& node = kGlassLoss[index.first + n][roughness.first + r];
        const float full = 0.001f * weight * specular, plain = 0.001f * weight - full;
        for (size_t side = 0; side < 2; ++side)
            for (size_t i = 0; i < lost[side].size(); ++i)
                lost[side][i] += full * node[side][0][i] + plain * node[side][1][i];
        crossing += full * kGlassCrossing[index.first + n][roughness.first + r];
    }
    crossing += 1.f - specular;
    // As much etendue times loss goes from the higher index to the lower as the other way.
    const float mean[2] = {mean_of(lost[0], weights), mean_of(lost[1], weights)};
    const float ratio = mean[0] > 0.f ? sqr(std::max(eta, 1.f / eta)) * mean[1] / mean[0] : 0.f;
    const float there = std::min(crossing, ratio), back = ratio > 0.f ? there / ratio : 0.f;
    const size_t front = eta < 1.f, behind = 1 - front;
    const float across = front ? back : there;
    crossing_[lane] = across;
    per_loss_[0][lane] = mean[front] > 0.f ? kInvPi * (1.f - across) / mean[front] : 0.f;
    per_loss_[1][lane] = mean[behind] > 0.f ? kInvPi * across / mean[behind] : 0.f;
    for (size_t i = 0; i < lost[0].size(); ++i) {
        lost_[0][i][lane] = lost[front][i];
        lost_[1][i][lane] = lost[behind][i];
    }
}

f4 GlassLoss::lost(float cosine, bool behind) const {
    const float place = std::sqrt(clamp_unit(cosine * (1.f + knee_) / (cosine + knee_))) * kLast;
    const Step step(place, kGlassLossCosines);
    const f4* row = &lost_[behind][static_cast<size_t>(step.first)];
    return row[0] + (row[1] - row[0]) * step.part;
}

f4 GlassLoss::lobe(float cosine, bool behind) const {
    return per_loss_[behind] * lost(cosine, behind) * cosine;
}

LostDirections::LostDirections(float alpha)
    : width_(3.f * alpha), near_(1.f / width_), far_(1.f / std::sqrt(sqr(width_) + 1.f)) {}

V3f LostDirections::draw(V2f u) const {
    const float cosine =
        clamp_unit(safe_sqrt(1.f / sqr(lerp(near_, far_, u.y)) - sqr(width_)));
    const float sine = safe_sqrt(1.f - sqr(cosine));
    const SinCos phi = sincos_turns(u.x);
    return {sine * phi.cosine, sine * phi.sine, cosine};
}

float LostDirections::pdf(float cosine) const {
    const float square = sqr(width_) + sqr(cosine);
    return cosine / (2.f * kPi * (near_ - far_) * square * std::sqrt(square));
}

}  // namespace petzval
