// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/edge_runs.h"

#include <algorithm>
#include <numbers>

namespace petzval::camera {
namespace {

constexpr double kCorner_rad = 6 * std::numbers::pi / 180;
/// Most runs that are kept by themselves, the longest first.
constexpr size_t kMostRuns = 64;
constexpr double kTurn = 2 * std::numbers::pi;
/// Width of a lobe, radians, below which its curve is as good as flat.
constexpr float kNarrow = 1e-3f;

struct Edge {
    double length, normal_rad, turn_before_rad;
};

std::vector<Edge> edges_of(const std::vector<V2d>& contour) {
    std::vector<Edge> out;
    for (size_t i = 0; i < contour.size(); ++i) {
        const V2d along = contour[(i + 1) % contour.size()] - contour[i];
        if (along.length() > 0)
            out.push_back({along.length(), std::atan2(along.y, along.x) - kTurn / 4, 0});
    }
    for (size_t i = 0; i < out.size(); ++i)
        out[i].turn_before_rad = std::remainder(
            out[i].normal_rad - out[(i + out.size() - 1) % out.size()].normal_rad, kTurn);
    return out;
}

}  // namespace

float light_up_to(float angle, float tanh_half) {
    return std::atan2(std::sin(angle / 2), tanh_half * std::cos(angle / 2)) / kPi;
}

std::vector<EdgeRun> edge_runs(std::span<const std::vector<V2d>> contours) {
    std::vector<EdgeRun> out;
    for (const std::vector<V2d>& contour : contours) {
        std::vector<Edge> edges = edges_of(contour);
        const auto corner = [](const Edge& e) {
            return std::fabs(e.turn_before_rad) > kCorner_rad;
        };
        const auto first = std::find_if(edges.begin(), edges.end(), corner);
        const bool closed = first == edges.end();
        std::rotate(edges.begin(), closed ? edges.begin() : first, edges.end());
        for (size_t i = 0; i < edges.size();) {
            EdgeRun run{edges[i].length, 0, 0};
            const double begins_rad = edges[i].normal_rad;
            size_t count = 1;
            for (++i; i < edges.size() && !corner(edges[i]); ++i, ++count) {
                run.length += edges[i].length;
                run.turn_rad += edges[i].turn_before_rad;
            }
            run.normal_rad = begins_rad + run.turn_rad / 2;
            // Each edge of an arc stands for the directions up to halfway to the next.
            if (count > 1) run.turn_rad *= double(count) / double(count - 1);
            run.turn_rad = std::min(std::fabs(run.turn_rad), kTurn);
            out.push_back(run);
        }
    }
    return out;
}

FarPattern::FarPattern(std::vector<EdgeRun> runs, double even_length, double radius)
    : radius_(static_cast<float>(radius)) {
    std::ranges::stable_sort(runs, {}, [](const EdgeRun& r) { return -r.length; });
    while (runs.size() > kMostRuns) even_length += runs.back().length, runs.pop_back();
    double sum = even_length;
    for (const EdgeRun& run : runs) sum += run.length;
    if (!(sum > 0)) return;
    even_ = static_cast<float>(even_length / sum);
    float before = even_;
    for (const EdgeRun& run : runs)
        for (const double side : {0., kTurn / 2}) {
            Lobe lobe{};
            lobe.angle = static_cast<float>(run.normal_rad + side);
            lobe.normal = {std::cos(lobe.angle), std::sin(lobe.angle)};
            lobe.share = static_cast<float>(run.length / (2 * sum));
            lobe.up_to = before += lobe.share;
            lobe.turn = static_cast<float>(run.turn_rad);
            lobe.width = static_cast<float>(1 / (kTurn * run.length));
            lobes_.push_back(lobe);
        }
}

V2f FarPattern::draw(float pick, V2f u) const {
    const float r = radius_ / (1 - u.x);
    if (pick < even_ || lobes_.empty()) {
        const float angle = 2 * kPi * u.y;
        return V2f(std::cos(angle), std::sin(angle)) * r;
    }
    auto lobe = std::ranges::upper_bound(lobes_, pick, {}, &Lobe::up_to);
    if (lobe == lobes_.end()) --lobe;
    const float along =
        std::clamp((pick - (lobe->up_to - lobe->share)) / lobe->share, 0.f, 1.f) - 0.5f;
    const float angle =
        lobe->angle + lobe->turn * along +
        2 * std::atan(std::tanh(lobe->width / (2 * r)) * std::tan(kPi * (u.y - 0.5f)));
    return V2f(std::cos(angle), std::sin(angle)) * r;
}

// Wrapped Lorentz (Cauchy) curve about the lobe's directions.
float FarPattern::Lobe::per_radian(V2f direction, float radius) const {
    const float g = width / radius;
    if (is_straight()) {
        // 1 - cos of the angle between, without what cancels.
        const float versine = 0.5f * (direction - normal).length2();
        if (g < kNarrow) return g / ((g * g / 2 + versine) * 2 * kPi);
        const float half = std::sinh(g / 2);
        return std::sinh(g) / ((2 * half * half + versine) * 2 * kPi);
    }
    const float t = std::tanh(g / 2);
    const float off = std::remainder(std::atan2(direction.y, direction.x) - angle, 2 * kPi);
    float sum = 0;
    // Half a turn further the arctangent begins anew.
    for (const float sign : {1.f, -1.f}) {
        const float edge = sign * off + turn / 2;
        const float wrapped = std::remainder(edge, 2 * kPi);
        sum += light_up_to(wrapped, t) + std::round((edge - wrapped) / (2 * kPi));
    }
    return sum / turn;
}

float FarPattern::density(V2f v) const {
    const float r = v.length();
    if (!(r >= radius_) || !std::isfinite(r)) return 0;
    float sum = even_ / (2 * kPi);
    const V2f direction = v / r;
    // Lobes of opposite sides follow each other.
    for (size_t i = 0; i < lobes_.size(); i += 2) {
        const Lobe& lobe = lobes_[i];
        const float g = lobe.width / r;
        if (!lobe.is_straight() || g >= kNarrow) {
            for (const Lobe& side : {lobe, lobes_[i + 1]})
                sum += side.share * side.per_radian(direction, r);
            continue;
        }
        const float cosine = std::fabs(lobe.normal.dot(direction)),
                    sine = lobe.normal.x * direction.y - lobe.normal.y * direction.x;
        const float near = sqr(sine) / (1 + cosine) + g * g / 2, far = 1 + cosine;
        sum += lobe.share * g * (near + far) / (near * far * 2 * kPi);
    }
    return sum * radius_ / (r * r * r);
}

}  // namespace petzval::camera
