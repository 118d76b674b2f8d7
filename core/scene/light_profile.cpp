// SPDX-License-Identifier: Apache-2.0
#include "core/scene/light_profile.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/math/trig.h"

namespace petzval {
namespace {

constexpr double kRadians = double(kPi) / 180;

struct Cell {
    size_t first;
    float weight;  // of the knot after the first
};

std::optional<Cell> cell_of(const std::vector<float>& knots, float at) {
    if (!(at >= knots.front() && at <= knots.back())) return std::nullopt;
    const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, at);
    const auto first = static_cast<size_t>(above - knots.begin()) - 1;
    return Cell{first, (at - knots[first]) / (knots[first + 1] - knots[first])};
}

// Integral of sin over [a, b] times what is 1 at a and 0 at b, or, where swapped, the other way.
double weight_of_end(double a, double b) {
    return std::cos(a) - (std::sin(b) - std::sin(a)) / (b - a);
}

}  // namespace

LightProfile::LightProfile(ProfilePole pole, std::vector<float> polar_deg,
                           std::vector<float> azimuth_deg, std::vector<float> intensity_cd)
    : pole_(pole),
      polar_deg_(std::move(polar_deg)),
      azimuth_deg_(std::move(azimuth_deg)),
      intensity_cd_(std::move(intensity_cd)),
      flux_lm_(static_cast<float>(integral())),
      reach_rad_(reach()) {}

float LightProfile::intensity(const V3f& d) const {
    const V3f turned = pole_ == ProfilePole::Forward ? d : V3f(d.y, d.z, -d.x);
    const float across = std::sqrt(sqr(turned.x) + sqr(turned.y));
    const f4 turns = atan2_turns(f4{turned.y, across, 0.f, 0.f}, f4{turned.x, turned.z, 1.f, 1.f});
    const float azimuth = turns[0] < 0.f ? turns[0] + 1.f : turns[0];
    const auto column = cell_of(azimuth_deg_, 360.f * azimuth);
    const auto row = cell_of(polar_deg_, std::min(360.f * turns[1], 180.f));
    if (!column || !row) return 0.f;
    const float* const a = &intensity_cd_[column->first * polar_deg_.size() + row->first];
    const float* const b = a + polar_deg_.size();
    return lerp(lerp(a[0], a[1], row->weight), lerp(b[0], b[1], row->weight), column->weight);
}

double LightProfile::integral() const {
    double sum = 0;
    for (size_t j = 0; j + 1 < azimuth_deg_.size(); ++j) {
        // The ends may stand for the same azimuths: only one turn counts.
        const double begin = std::max(double(azimuth_deg_[j]), 0.);
        const double end = std::min(double(azimuth_deg_[j + 1]), 360.);
        if (!(end > begin)) continue;
        const double width = double(azimuth_deg_[j + 1]) - double(azimuth_deg_[j]);
        const double middle = ((begin + end) / 2 - double(azimuth_deg_[j])) / width;
        for (size_t i = 0; i + 1 < polar_deg_.size(); ++i) {
            const auto at = [&](size_t row) {
                const float* const value = &intensity_cd_[j * polar_deg_.size() + row];
                return (1 - middle) * double(value[0]) + middle * double(value[polar_deg_.size()]);
            };
            const double a = kRadians * double(polar_deg_[i]);
            const double b = kRadians * double(polar_deg_[i + 1]);
            const double whole = std::cos(a) - std::cos(b), first = weight_of_end(a, b);
            sum += (at(i) * first + at(i + 1) * (whole - first)) * kRadians * (end - begin);
        }
    }
    return sum;
}

float LightProfile::reach() const {
    if (pole_ == ProfilePole::Side) return kPi / 2;
    size_t last = 0;
    for (size_t k = 0; k < intensity_cd_.size(); ++k)
        if (intensity_cd_[k] > 0) last = std::max(last, k % polar_deg_.size() + 1);
    last = std::min(last, polar_deg_.size() - 1);
    return std::min(static_cast<float>(kRadians * double(polar_deg_[last])), kPi);
}

}  // namespace petzval
