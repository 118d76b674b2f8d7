// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/star_aim.h"

#include <algorithm>
#include <cmath>

namespace petzval::camera {
namespace {

/// Half widths of the window within which a spike is followed exactly.
constexpr float kNear = 3;

/// Inverse of light_up_to().
float angle_of(float light, float tanh_half) {
    return 2 * std::atan(tanh_half * std::tan(kPi * light));
}

}  // namespace

StarAim::StarAim(const FarPattern& pattern, V2f middle, float disc_radius)
    : away_(middle.length()), disc_radius_(disc_radius) {
    direction_ = middle / away_;
    half_angle_ = std::asin(disc_radius_ / away_);
    float even = pattern.even_share() * half_angle_ / kPi, all = 0;
    for (const FarPattern::Lobe& lobe : pattern.lobes()) {
        const float cosine = lobe.normal.dot(direction_);
        const float sine = lobe.normal.x * direction_.y - lobe.normal.y * direction_.x;
        const bool near = lobe.is_straight() && cosine > 0 &&
                          std::fabs(sine) < kNear * (half_angle_ + lobe.width / away_);
        if (!near || count_ == kMostSpikes) {
            even += lobe.share * lobe.per_radian(direction_, away_) * 2 * half_angle_;
            continue;
        }
        Spike& spike = spikes_[count_++];
        spike.turned = -std::atan2(sine, cosine);
        spike.from = -spike.turned - half_angle_, spike.to = -spike.turned + half_angle_;
        spike.tanh_half = std::tanh(lobe.width / (2 * away_));
        spike.passed =
            light_up_to(spike.to, spike.tanh_half) - light_up_to(spike.from, spike.tanh_half);
        spike.share = lobe.share * spike.passed;
        all += spike.share;
    }
    all += even;
    if (!(all > 0)) return;
    evenly_ = even / all;
    for (size_t i = 0; i < count_; ++i) spikes_[i].share /= all;
    // Mean chord of a disc.
    share_ = all * pattern.radius() * (kPi / 2 * disc_radius_) / (away_ * away_);
}

V2f StarAim::draw(V2f u) const {
    float off = 0, left = u.y;
    if (left < evenly_ || count_ == 0) {
        off = (2 * std::min(left / evenly_, 1.f) - 1) * half_angle_;
    } else {
        left -= evenly_;
        size_t i = 0;
        while (i + 1 < count_ && left >= spikes_[i].share) left -= spikes_[i++].share;
        const Spike& spike = spikes_[i];
        const float light = light_up_to(spike.from, spike.tanh_half) +
                            spike.passed * std::clamp(left / spike.share, 0.f, 1.f);
        off = spike.turned + angle_of(light, spike.tanh_half);
    }
    const float s = std::sin(off), c = std::cos(off);
    const float half_chord = safe_sqrt(sqr(disc_radius_) - sqr(away_ * s));
    const float r = away_ * c + half_chord * (2 * u.x - 1);
    return V2f(direction_.x * c - direction_.y * s, direction_.y * c + direction_.x * s) * r;
}

float StarAim::density(V2f v) const {
    const float r = v.length();
    const float s = (direction_.x * v.y - direction_.y * v.x) / r, c = direction_.dot(v) / r;
    const float half_chord = safe_sqrt(sqr(disc_radius_) - sqr(away_ * s));
    // What was drawn at the very edge may be rounded over it.
    constexpr float rounded = 1e-5f;
    if (!(c > 0 && half_chord > 0 && std::fabs(r - away_ * c) <= half_chord + rounded * r))
        return 0;
    float sum = evenly_ / (2 * half_angle_);
    const float off = std::atan2(s, c);
    for (size_t i = 0; i < count_; ++i) {
        const Spike& spike = spikes_[i];
        const float half = (off - spike.turned) / 2, t = spike.tanh_half;
        // Derivative of light_up_to().
        const float per_radian = t / (2 * kPi * (sqr(std::sin(half)) + sqr(t * std::cos(half))));
        sum += spike.share / spike.passed * per_radian;
    }
    return sum / (2 * half_chord * r);
}

}  // namespace petzval::camera
