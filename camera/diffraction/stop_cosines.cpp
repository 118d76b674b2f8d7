// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/stop_cosines.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval::camera {
namespace {

/// Farthest place from the middle of the frame, along an edge, in frames; and up to where the fit
/// goes, beyond which it is continued straight.
constexpr float kReach = 1, kFitted = 0.55f;
constexpr int kSamples = 17;

/// Powers of right and down, of each term.
constexpr std::array<std::array<int, 2>, 12> kPowers{{{1, 0},
                                                      {0, 1},
                                                      {3, 0},
                                                      {2, 1},
                                                      {1, 2},
                                                      {0, 3},
                                                      {5, 0},
                                                      {4, 1},
                                                      {3, 2},
                                                      {2, 3},
                                                      {1, 4},
                                                      {0, 5}}};

struct SlopeSample {
    V2d from_middle, slope;
};

template <class Camera>
V2d tangents_of(const Camera& camera, V2f film) {
    if constexpr (requires { camera.pencil(film).tangents; })
        return camera.pencil(film).tangents;
    else
        return camera.pencil(film, double(kMiddle_nm)).tangents;
}

template <class Camera>
std::vector<SlopeSample> slope_samples(const Camera& camera, float& index) {
    index = 1;
    std::vector<SlopeSample> out;
    for (int k = 0; k < kSamples * kSamples; ++k) {
        const V2f at(kFitted * (2 * float(k % kSamples) / (kSamples - 1) - 1),
                     kFitted * (2 * float(k / kSamples) / (kSamples - 1) - 1));
        out.push_back({V2d(at), tangents_of(camera, at + V2f(0.5f))});
    }
    return out;
}

/// Index of the medium about the stop: what cosines at the film change by the stop's place is what
/// optical cosines at the stop change by the film's (Hamilton).
float index_about_stop(const LensCamera& camera, const LensIndices<f8>& indices) {
    constexpr float air = 0.03f;  // nothing else comes as near to 1
    const float stop_mm = 0.1f * camera.input().iris.bounding_radius_mm(),
                film_mm = 0.02f * float(camera.input().film_width_mm);
    LeadPoints points;
    points.nm = splat8(kMiddle_nm);
    points.film_mm[2] = V2f(film_mm, 0), points.film_mm[3] = V2f(-film_mm, 0);
    PlanePoint<f8> stop(f8{}, f8{});
    stop.x[0] = stop_mm, stop.x[1] = -stop_mm;
    const LeadRays rays = camera.optics().aim(points, stop, indices);
    for (int i = 0; i < 4; ++i)
        if (!rays.aimed.found[i]) return 1;
    const float at_film = (rays.aimed.l[0] - rays.aimed.l[1]) / stop_mm,
                at_stop = (rays.aimed.ray.direction.x[2] - rays.aimed.ray.direction.x[3]) / film_mm;
    const float index = std::fabs(at_film / at_stop);
    return std::isfinite(index) && std::fabs(index - 1) > air ? index : 1;
}

std::vector<SlopeSample> slope_samples(const LensCamera& camera, float& index) {
    LeadPoints points;
    points.nm = splat8(kMiddle_nm);
    const LensIndices<f8> indices = camera.input().lens->indices(points.nm);
    index = index_about_stop(camera, indices);
    std::vector<SlopeSample> out;
    for (int k = 0; k < kSamples * kSamples; ++k) {
        const V2f at(kFitted * (2 * float(k % kSamples) / (kSamples - 1) - 1),
                     kFitted * (2 * float(k / kSamples) / (kSamples - 1) - 1));
        points.film_mm.fill(camera.film_mm(at + V2f(0.5f)));
        const LeadRays rays = camera.optics().aim(points, PlanePoint<f8>(f8{}, f8{}), indices);
        if (!rays.aimed.found[0]) continue;
        const auto& d = rays.aimed.ray.direction;
        out.push_back({V2d(at), V2d(double(d.x[0]), double(d.y[0])) / std::fabs(double(d.z[0]))});
    }
    return out;
}

/// Least squares by normal equations, with pivots.
std::vector<V2d> fitted(const std::vector<SlopeSample>& samples, size_t terms) {
    std::vector<std::vector<double>> a(terms, std::vector<double>(terms + 2, 0));
    for (const SlopeSample& s : samples) {
        std::vector<double> row(terms);
        for (size_t i = 0; i < terms; ++i)
            row[i] =
                std::pow(s.from_middle.x, kPowers[i][0]) * std::pow(s.from_middle.y, kPowers[i][1]);
        for (size_t i = 0; i < terms; ++i) {
            for (size_t j = 0; j < terms; ++j) a[i][j] += row[i] * row[j];
            a[i][terms] += row[i] * s.slope.x, a[i][terms + 1] += row[i] * s.slope.y;
        }
    }
    for (size_t k = 0; k < terms; ++k) {
        size_t best = k;
        for (size_t i = k; i < terms; ++i)
            if (std::fabs(a[i][k]) > std::fabs(a[best][k])) best = i;
        std::swap(a[k], a[best]);
        if (a[k][k] == 0) continue;
        for (size_t i = 0; i < terms; ++i)
            for (size_t j = terms + 2; i != k && j-- > k;) a[i][j] -= a[i][k] / a[k][k] * a[k][j];
    }
    std::vector<V2d> out;
    for (size_t k = 0; k < terms; ++k)
        out.push_back(a[k][k] == 0 ? V2d(0.)
                                   : V2d(a[k][terms] / a[k][k], a[k][terms + 1] / a[k][k]));
    return out;
}

}  // namespace

StopCosines::StopCosines(const StopCamera& camera) {
    terms_.fill(V2f(0.f));
    const std::vector<SlopeSample> samples =
        std::visit([&](const auto& c) { return slope_samples(*c, index_); }, camera);
    const bool is_linear = !std::holds_alternative<std::shared_ptr<const LensCamera>>(camera) ||
                           samples.size() < 4 * kTerms;
    const std::vector<V2d> found = fitted(samples, is_linear ? 2 : kTerms);
    for (size_t k = 0; k < found.size(); ++k) terms_[k] = V2f(found[k]);
}

auto StopCosines::slopes(V2f from_middle) const -> Slopes {
    const float x = std::clamp(from_middle.x, -kFitted, kFitted),
                y = std::clamp(from_middle.y, -kFitted, kFitted);
    const float x2 = x * x, y2 = y * y;
    const std::array<float, kTerms> value{x,           y,           x * x2,      x2 * y,
                                          x * y2,      y * y2,      x * x2 * x2, x2 * x2 * y,
                                          x * x2 * y2, x2 * y * y2, x * y2 * y2, y * y2 * y2};
    const std::array<float, kTerms> by_x{1,           0,
                                         3 * x2,      2 * x * y,
                                         y2,          0,
                                         5 * x2 * x2, 4 * x * x2 * y,
                                         3 * x2 * y2, 2 * x * y * y2,
                                         y2 * y2,     0};
    const std::array<float, kTerms> by_y{0,
                                         1,
                                         0,
                                         x2,
                                         2 * x * y,
                                         3 * y2,
                                         0,
                                         x2 * x2,
                                         2 * x * x2 * y,
                                         3 * x2 * y2,
                                         4 * x * y * y2,
                                         5 * y2 * y2};
    Slopes out{V2f(0.f), V2f(0.f), V2f(0.f)};
    for (size_t k = 0; k < kTerms; ++k) {
        out.slope += terms_[k] * value[k];
        out.by_right += terms_[k] * by_x[k];
        out.by_down += terms_[k] * by_y[k];
    }
    out.slope += out.by_right * (from_middle.x - x) + out.by_down * (from_middle.y - y);
    return out;
}

// Cosines are slope / sqrt(1 + slope^2); their area by that of slopes is (1 + slope^2)^-2.
auto StopCosines::at(V2f film) const -> At {
    const Slopes s = slopes(film - V2f(0.5f));
    const float over = 1 / (1 + s.slope.length2());
    return {
        s.slope * (index_ * std::sqrt(over)),
        std::fabs(s.by_right.x * s.by_down.y - s.by_right.y * s.by_down.x) * sqr(over * index_)};
}

std::optional<V2f> StopCosines::film_of(V2f cosines) const {
    constexpr int steps = 4;
    const V2f c = cosines / index_;
    const float rest = 1 - c.length2();
    if (!(rest > 0)) return std::nullopt;
    const V2f wanted = c / std::sqrt(rest);
    V2f at(0.f);
    for (int i = 0; i < steps; ++i) {
        const Slopes s = slopes(at);
        const V2f off = wanted - s.slope;
        const float area = s.by_right.x * s.by_down.y - s.by_right.y * s.by_down.x;
        at += V2f(off.x * s.by_down.y - off.y * s.by_down.x,
                  off.y * s.by_right.x - off.x * s.by_right.y) /
              area;
        if (!(std::fabs(at.x) <= 2 * kReach && std::fabs(at.y) <= 2 * kReach)) return std::nullopt;
    }
    if (!(std::fabs(at.x) <= kReach && std::fabs(at.y) <= kReach)) return std::nullopt;
    return at + V2f(0.5f);
}

}  // namespace petzval::camera
