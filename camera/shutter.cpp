// SPDX-License-Identifier: Apache-2.0
#include "camera/shutter.h"

#include <algorithm>
#include <cmath>

#include "core/math/steps.h"

namespace petzval::camera {
namespace {

float area_before(const ShutterCurve& curve, size_t point) {
    const auto &a = curve.points[point - 1], &b = curve.points[point];
    return (b.time - a.time) * (a.open + b.open) / 2;
}

}  // namespace

float ShutterCurve::efficiency() const {
    float area = 0, peak = points.front().open;
    for (size_t i = 1; i < points.size(); ++i) {
        area += area_before(*this, i);
        peak = std::max(peak, points[i].open);
    }
    return area / peak;
}

Shutter::Shutter(ShutterCurve curve, std::span<const M44f> to_world, const M44f& in_the_middle)
    : curve_(std::move(curve)), reached_{0.f} {
    // Only ratios count, and the squares below must stay within the range of floats.
    float peak = 0;
    for (const ShutterCurve::Point& point : curve_.points) peak = std::max(peak, point.open);
    for (ShutterCurve::Point& point : curve_.points) point.open /= peak;
    for (size_t i = 1; i < curve_.points.size(); ++i)
        reached_.push_back(reached_.back() + area_before(curve_, i));
    const float whole = reached_.back();
    for (float& share : reached_) share /= whole;
    const M44d back = M44d(in_the_middle).inverse();
    for (const M44f& place : to_world) from_middle_.push_back(back * M44d(place));
}

float Shutter::time(float u) const {
    const auto at = std::upper_bound(reached_.begin() + 1, reached_.end() - 1, u);
    const auto i = static_cast<size_t>(at - reached_.begin());
    const auto &a = curve_.points[i - 1], &b = curve_.points[i];
    const float share =
        std::clamp((u - reached_[i - 1]) / (reached_[i] - reached_[i - 1]), 0.f, 1.f);
    // The part s of the way with a s + (b - a) s^2 / 2 = share (a + b) / 2, without cancellation.
    const float root = std::sqrt(lerp(a.open * a.open, b.open * b.open, share));
    const float sum = a.open + root;  // 0 at the very start of a piece that begins closed
    const float s = a.open == b.open ? share : sum > 0.f ? share * (a.open + b.open) / sum : 0.f;
    return std::min(lerp(a.time, b.time, s), kOneMinus);
}

M44d Shutter::moved(float time) const {
    if (from_middle_.empty()) return {};
    const auto [before, share] = step_place(double(time), from_middle_.size());
    return from_middle_[before] * (1 - share) + from_middle_[before + 1] * share;
}

void Shutter::move(Ray& ray) const {
    if (from_middle_.empty()) return;
    const M44d m = moved(ray.time);
    V3d origin, direction;
    m.multVecMatrix(V3d(ray.origin), origin);
    m.multDirMatrix(V3d(ray.direction), direction);
    ray.origin = V3f(origin);
    ray.direction = V3f(direction.normalized());
}

V3d Shutter::seen_from_middle(const V3f& p, float time) const {
    return V3d(p) * moved(time).inverse();
}

}  // namespace petzval::camera
