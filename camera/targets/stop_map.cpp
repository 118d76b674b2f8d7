// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/stop_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval::camera {
namespace {

constexpr size_t kPoints = 160;  ///< of the stop, a multiple of 8
constexpr size_t kTerms = StopMap::kTerms;
/// Points that the fit needs: with fewer it says little of what lies between.
constexpr size_t kFewest = 2 * kTerms;
/// Weight of a ray that a rim stops: it only keeps the polynomial from running away.
constexpr double kBlockedWeight = 0.01;
/// Slope of rays over the largest of clear ones, above which they lead nowhere near.
constexpr double kAside = 3;

/// Wavelengths count by 1 / nm^2, of which indices are smooth functions (Cauchy 1836): 0 at line d.
constexpr double kUnit_per_nm2 = 2e-6;
float wave_of(float nm) {
    return static_cast<float>((1 / (double(nm) * double(nm)) - 1 / sqr(kLineD_nm)) / kUnit_per_nm2);
}
float nm_of(float wave) {
    return static_cast<float>(1 / std::sqrt(double(wave) * kUnit_per_nm2 + 1 / sqr(kLineD_nm)));
}
/// Waves at which rays are traced, beside line d: 690, 490 and 425 nm, about.
constexpr std::array<float, 3> kWaves{-0.4f, 0.6f, 1.3f};

/// Points of a disc, by the golden angle; more of them near its rim.
std::array<V2f, kPoints> spread() {
    std::array<V2f, kPoints> out;
    for (size_t i = 0; i < kPoints; ++i) {
        const double r = std::pow((double(i) + 0.75) / kPoints, 0.4),
                     angle = 2.39996323 * double(i);
        out[i] = V2f(V2d(r * std::cos(angle), r * std::sin(angle)));
    }
    return out;
}

using Row = std::array<double, kTerms>;
Row monomials(V2f s) {
    Row out;
    size_t k = 0;
    double y = 1;
    for (int j = 0; j <= StopMap::kDegree; ++j, y *= double(s.y)) {
        double x = y;
        for (int i = 0; i <= StopMap::kDegree - j; ++i, x *= double(s.x)) out[k++] = x;
    }
    return out;
}

/// Weighted least squares by the normal equations, which are factorised once (Cholesky).
class LeastSquares {
  public:
    LeastSquares(const std::vector<Row>& rows, const std::array<double, kPoints>& weights)
        : rows_(rows), weights_(weights), l_(kTerms * kTerms) {
        for (size_t i = 0; i < kTerms; ++i)
            for (size_t j = 0; j <= i; ++j) {
                double sum = i == j ? 1e-9 : 0;
                for (size_t p = 0; p < kPoints; ++p) sum += weights[p] * rows[p][i] * rows[p][j];
                for (size_t k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
                at(i, j) = i == j ? std::sqrt(std::fmax(sum, 1e-12)) : sum / at(j, j);
            }
    }
    [[nodiscard]] Row solved(const std::array<double, kPoints>& values) const {
        Row out{};
        for (size_t p = 0; p < kPoints; ++p)
            if (weights_[p] > 0)
                for (size_t i = 0; i < kTerms; ++i) out[i] += weights_[p] * values[p] * rows_[p][i];
        for (size_t i = 0; i < kTerms; ++i) {
            for (size_t k = 0; k < i; ++k) out[i] -= at(i, k) * out[k];
            out[i] /= at(i, i);
        }
        for (size_t i = kTerms; i-- > 0;) {
            for (size_t k = i + 1; k < kTerms; ++k) out[i] -= at(k, i) * out[k];
            out[i] /= at(i, i);
        }
        return out;
    }

  private:
    [[nodiscard]] double& at(size_t i, size_t j) { return l_[i * kTerms + j]; }
    [[nodiscard]] double at(size_t i, size_t j) const { return l_[i * kTerms + j]; }
    const std::vector<Row>& rows_;
    const std::array<double, kPoints>& weights_;
    std::vector<double> l_;
};

using TracedRays = std::array<StopRay, kPoints>;
template <class StopOf>
TracedRays traced(const StopCamera& camera, V2f film, float nm, const StopOf& stop_mm) {
    TracedRays out;
    for (size_t first = 0; first < kPoints; first += 8) {
        std::array<StopPoint, 8> eight;
        for (size_t i = 0; i < 8; ++i) eight[i] = {film, stop_mm(first + i), nm};
        const auto rays = rays_through(camera, eight);
        std::copy(rays.begin(), rays.end(), out.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return out;
}

}  // namespace

// 1, x, y, x^2, xy, y^2, w, w^2, w^3
auto StopMap::weights(V2f in_cell, float wave) -> Weights {
    return {1,
            in_cell.x,
            in_cell.y,
            in_cell.x * in_cell.x,
            in_cell.x * in_cell.y,
            in_cell.y * in_cell.y,
            wave,
            wave * wave,
            wave * wave * wave};
}

// Its axes are those along which the clear points lie farthest apart and least.
void StopMap::find_ellipse(const StopCamera& camera) {
    constexpr float kWider = 1.04f;
    static const std::array<V2f, kPoints> disc = spread();
    const auto reach = static_cast<float>(stop_reach_mm(camera));
    half_mm_ = V2f(reach);
    const TracedRays rays =
        traced(camera, middle_, kMiddle_nm, [&](size_t p) { return disc[p] * reach; });
    float count = 0, xx = 0, xy = 0, yy = 0;
    V2f mean(0.f);
    for (size_t p = 0; p < kPoints; ++p)
        if (rays[p].clear) mean += disc[p], ++count;
    if (count > 0.99f * kPoints || count < 8) return;
    mean /= count;
    for (size_t p = 0; p < kPoints; ++p) {
        if (!rays[p].clear) continue;
        const V2f d = disc[p] - mean;
        xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    }
    const float angle = std::atan2(2 * xy, xx - yy) / 2;
    long_axis_ = V2f(std::cos(angle), std::sin(angle));
    V2f low(INFINITY), high(-INFINITY);
    for (size_t p = 0; p < kPoints; ++p) {
        if (!rays[p].clear) continue;
        const V2f at(disc[p].dot(long_axis_), disc[p].dot(short_axis()));
        low = V2f(std::min(low.x, at.x), std::min(low.y, at.y));
        high = V2f(std::max(high.x, at.x), std::max(high.y, at.y));
    }
    // What lies between the points that were tried.
    const float between = 1.5f / std::sqrt(float(kPoints));
    const V2f middle = (low + high) / 2;
    half_mm_ = V2f(std::min(1.f, kWider * (high.x - low.x) / 2 + between),
                   std::min(1.f, kWider * (high.y - low.y) / 2 + between)) *
               reach;
    stop_mm_ = (long_axis_ * middle.x + short_axis() * middle.y) * reach;
    float farthest = 1;
    for (size_t p = 0; p < kPoints; ++p)
        if (rays[p].clear)
            farthest = std::max(farthest, kWider * on_disc(disc[p] * reach).length());
    half_mm_ *= farthest;
}

std::shared_ptr<const StopMap> StopMap::of(const StopCamera& camera, const FilmCell& cell) {
    auto out = std::make_shared<StopMap>();
    StopMap& map = *out;
    map.middle_ = (cell.first + cell.last) / 2;
    map.half_ = (cell.last - cell.first) / 2;
    map.find_ellipse(camera);
    static const std::array<V2f, kPoints> stop = spread();
    constexpr std::array<std::array<float, 3>, kPlaces> kAt{{{0, 0, 0},
                                                             {1, 0, 0},
                                                             {-1, 0, 0},
                                                             {0, 1, 0},
                                                             {0, -1, 0},
                                                             {1, 1, 0},
                                                             {0, 0, kWaves[0]},
                                                             {0, 0, kWaves[1]},
                                                             {0, 0, kWaves[2]}}};
    const auto rays_at = [&](const std::array<float, 3>& at) {
        return traced(camera, map.middle_ + V2f(at[0], at[1]) * map.half_, nm_of(at[2]),
                      [&](size_t p) { return map.stop_mm(stop[p]); });
    };
    std::array<TracedRays, kPlaces> rays;
    for (size_t k = 0; k < kPlaces; ++k) rays[k] = rays_at(kAt[k]);
    // The frame is that of clear rays. Of what rims stop, rays count that go about the same way.
    std::array<double, kPoints> weight{};
    V3d origin(0.), axis(0.);
    double clear_rays = 0;
    for (const StopRay& ray : rays[0]) {
        if (!ray.clear) continue;
        ++clear_rays;
        origin += ray.origin_m, axis += ray.direction.normalized();
    }
    if (clear_rays == 0) return nullptr;
    map.origin_m_ = origin / clear_rays;
    map.axis_ = axis.normalized();
    const V3d aside = std::fabs(map.axis_.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    map.right_ = (aside - map.axis_ * aside.dot(map.axis_)).normalized();
    map.up_ = map.right_.cross(map.axis_);
    const auto slope = [&](const StopRay& ray) {
        const V3d d = map.turned(ray.direction);
        return d.z > 0 ? std::hypot(d.x, d.y) / d.z : INFINITY;
    };
    double steepest = 0;
    for (const TracedRays& at : rays)
        for (const StopRay& ray : at)
            if (ray.clear) steepest = std::max(steepest, slope(ray));
    size_t count = 0;
    for (size_t p = 0; p < kPoints; ++p) {
        bool counts = true, clear = false;
        for (const TracedRays& at : rays) {
            counts = counts && at[p].exists && slope(at[p]) < kAside * steepest;
            clear = clear || at[p].clear;
        }
        if (!counts) continue;
        ++count;
        weight[p] = clear ? 1 : kBlockedWeight;
    }
    if (count < kFewest) return nullptr;
    std::vector<Row> rows;
    for (const V2f& s : stop) rows.push_back(monomials(s));
    const LeastSquares fit(rows, weight);
    std::array<std::array<Row, 4>, kPlaces> of_places;
    for (size_t k = 0; k < kPlaces; ++k) {
        std::array<std::array<double, kPoints>, 4> parts{};
        for (size_t p = 0; p < kPoints; ++p) {
            if (!(weight[p] > 0)) continue;
            const auto v = map.parts(rays[k][p]);
            for (size_t c = 0; c < 4; ++c) parts[c][p] = v[c];
        }
        for (size_t c = 0; c < 4; ++c) of_places[k][c] = fit.solved(parts[c]);
    }
    for (size_t i = 0; i < kTerms; ++i)
        for (size_t c = 0; c < 4; ++c) {
            const auto v = [&](size_t k) { return of_places[k][c][i]; };
            const double xx = (v(1) + v(2)) / 2 - v(0), yy = (v(3) + v(4)) / 2 - v(0),
                         x = (v(1) - v(2)) / 2, y = (v(3) - v(4)) / 2;
            // Divided differences (Newton) of the three waves, over w.
            const std::array<double, 3> w{double(kWaves[0]), double(kWaves[1]), double(kWaves[2])};
            const double d0 = (v(6) - v(0)) / w[0], d1 = (v(7) - v(0)) / w[1],
                         d2 = (v(8) - v(0)) / w[2], d01 = (d1 - d0) / (w[1] - w[0]),
                         d12 = (d2 - d1) / (w[2] - w[1]), d012 = (d12 - d01) / (w[2] - w[0]);
            const std::array<double, kPlaces> terms{v(0),
                                                    x,
                                                    y,
                                                    xx,
                                                    v(5) - v(0) - x - y - xx - yy,
                                                    yy,
                                                    d0 - w[0] * d01 + w[0] * w[1] * d012,
                                                    d01 - (w[0] + w[1]) * d012,
                                                    d012};
            for (size_t k = 0; k < kPlaces; ++k)
                map.terms_[i][k][int(c)] = static_cast<float>(terms[k]);
        }
    const auto check = [&](const std::array<float, 3>& at, const TracedRays& found) {
        const Rays here = map.rays(map.middle_ + V2f(at[0], at[1]) * map.half_, nm_of(at[2]));
        for (size_t p = 0; p < kPoints; ++p) {
            if (!found[p].clear) continue;
            const auto v = map.parts(found[p]);
            const f4 fitted = camera::at(here, stop[p]);
            const auto apart = [&](size_t a, size_t b) {
                return static_cast<float>(
                    std::hypot(v[a] - double(fitted[int(a)]), v[b] - double(fitted[int(b)])));
            };
            V2f& most = map.error_[square(stop[p])];
            most = V2f(std::fmax(most.x, apart(0, 1)), std::fmax(most.y, apart(2, 3)));
            map.most_slope_ =
                std::fmax(map.most_slope_, static_cast<float>(std::hypot(v[2], v[3])));
        }
    };
    for (size_t k = 0; k < kPlaces; ++k) check(kAt[k], rays[k]);
    for (const auto& at : {std::array{0.6f, -0.7f, 0.25f}, std::array{-0.8f, 0.5f, 0.9f}})
        check(at, rays_at(at));
    map.find_bounds();
    return out;
}

// Second derivatives are taken from differences of values: at the middles of squares and half-way
// to their neighbours.
void StopMap::find_bounds() {
    constexpr float kMargin = 1.5f, kErrorMargin = 2.f, kStep = 0.5f / kSquares;
    const Rays middle = rays(middle_, kMiddle_nm);
    // Few rays cross each square: its neighbours count as well.
    const auto found = error_;
    for (size_t n = 0; n < kSquares2; ++n) {
        const int i = int(n) % kSquares, j = int(n) / kSquares;
        for (int y = std::max(j - 1, 0); y <= std::min(j + 1, kSquares - 1); ++y)
            for (int x = std::max(i - 1, 0); x <= std::min(i + 1, kSquares - 1); ++x) {
                const V2f there = kErrorMargin * found[size_t(y * kSquares + x)];
                error_[n] = V2f(std::max(error_[n].x, there.x), std::max(error_[n].y, there.y));
            }
        // The polynomial means nothing beyond the disc.
        V2f at_n = middle_of(n);
        const float farthest = 1 - 1.5f * kStep;
        if (at_n.length() > farthest) at_n *= farthest / at_n.length();
        std::array<f4, 9> around;
        for (int k = 0; k < 9; ++k)
            around[size_t(k)] =
                camera::at(middle, at_n + V2f(float(k % 3 - 1), float(k / 3 - 1)) * kStep);
        const f4 xx = around[3] - 2 * around[4] + around[5],
                 yy = around[1] - 2 * around[4] + around[7],
                 xy = (around[0] + around[8] - around[2] - around[6]) / 4;
        const f4 squares = xx * xx + 2 * xy * xy + yy * yy;
        bend_[n] = V2f(std::sqrt(squares[0] + squares[1]), std::sqrt(squares[2] + squares[3])) *
                   (kMargin / (kStep * kStep));
    }
    for (const V2f& corner : {V2f(1, 1), V2f(-1, 1), V2f(1, -1), V2f(-1, -1)})
        for (const float nm : kTried_nm) {
            const Rays there = rays(middle_ + corner * half_, nm);
            for (const V2f& s :
                 {V2f(0.f), V2f(0.9f, 0), V2f(-0.9f, 0), V2f(0, 0.9f), V2f(0, -0.9f)}) {
                const f4 by = camera::at(there, s) - camera::at(middle, s);
                moves_.x = std::max(moves_.x, std::hypot(by[0], by[1]));
                moves_.y = std::max(moves_.y, std::hypot(by[2], by[3]));
            }
        }
    moves_ *= kMargin;
}

std::array<double, 4> StopMap::parts(const StopRay& ray) const {
    const V3d o = local(ray.origin_m), d = turned(ray.direction);
    const V2d slope(d.x / d.z, d.y / d.z);
    return {o.x - o.z * slope.x, o.y - o.z * slope.y, slope.x, slope.y};
}

auto StopMap::weighed(const Weights& w) const -> Rays {
    Rays out;
    for (size_t i = 0; i < kTerms; ++i) {
        f4 sum = terms_[i][0] * w[0];
        for (size_t k = 1; k < kPlaces; ++k) sum += terms_[i][k] * w[k];
        out[i] = sum;
    }
    return out;
}

auto StopMap::rays(V2f film, float nm) const -> Rays {
    return weighed(weights((film - middle_) / half_, wave_of(nm)));
}

auto StopMap::rays_by_film(V2f film) const -> std::array<Rays, 2> {
    const V2f at = (film - middle_) / half_;
    return {weighed({0, 1 / half_.x, 0, 2 * at.x / half_.x, at.y / half_.x}),
            weighed({0, 0, 1 / half_.y, 0, at.x / half_.y, 2 * at.y / half_.y})};
}

f4 at(const StopMap::Rays& rays, V2f s) {
    f4 out{};
    size_t end = StopMap::kTerms;
    for (int j = StopMap::kDegree; j >= 0; --j) {
        const size_t count = static_cast<size_t>(StopMap::kDegree - j) + 1;
        f4 row = rays[end - 1];
        for (size_t i = 2; i <= count; ++i) row = row * s.x + rays[end - i];
        out = out * s.y + row;
        end -= count;
    }
    return out;
}

}  // namespace petzval::camera
