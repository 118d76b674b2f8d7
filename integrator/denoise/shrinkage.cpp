// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/shrinkage.h"

#include <algorithm>
#include <cmath>

namespace petzval::integrator {
namespace {

using Imath::V3d;

/// Two halves of a pixel, and the estimates that were made of each.
struct PixelHalves {
    V3d a, b, of_a, of_b;
};

PixelHalves halves_of(const Film& film, const HalfEstimates& estimates, int x, int y) {
    const size_t at = estimates.offset(x, y);
    return {V3d(film.half(x, y, 0).colour), V3d(film.half(x, y, 1).colour),
            V3d(estimates.colour[0][at]), V3d(estimates.colour[1][at])};
}

/// x: what of a pixel's squared error goes with the way to its estimate; y: the square of that way.
/// Of their sums over many pixels the ratio is the part of the way that leaves the least error.
using WayShares = Imath::V2d;

/// Part of the way. The ratio is noisy, and more than all of the way does not help: where the best
/// is all of it, half of the ratios are less by chance. A fifth more makes up for most.
double part_of(const WayShares& sums) {
    constexpr double kMore = 1.2;
    return sums.y > 0 ? std::clamp(kMore * sums.x / sums.y, 0., 1.) : 1.;
}

// The picture is M = (A + B) / 2, its estimate E = (D(A) + D(B)) / 2, the truth T. M + part (E - M)
// has the least squared error where part is the mean of (M - T) (M - E) over that of (M - E)^2. The
// noise of the halves is independent and alike, so (A - B) (A - B - D(A) + D(B)) / 4 is on average
// (M - T) (M - E). It is shrinkage as of Stein (1956), towards estimates that are noisy too.
WayShares shares_of(const PixelHalves& p) {
    const V3d apart = p.a - p.b, way = (p.a + p.b - p.of_a - p.of_b) / 2;
    return {apart.dot(apart - (p.of_a - p.of_b)) / 4, way.dot(way)};
}

/// Sums of a rectangle of pixels, row by row; T(0) to begin with.
template <class T>
class Pixels {
  public:
    explicit Pixels(const Rect& where)
        : where_(where),
          values_(static_cast<size_t>(where.width()) * static_cast<size_t>(where.height()), T(0)) {}
    [[nodiscard]] const Rect& where() const { return where_; }
    [[nodiscard]] T& operator()(int x, int y) {
        return values_[static_cast<size_t>(y - where_.y0) * size_t(where_.width()) +
                       size_t(x - where_.x0)];
    }

  private:
    Rect where_;
    std::vector<T> values_;
};

// Sums about the pixels of `where`, by the weight of the distance along a row and along a column.
template <class T, class Weight>
Pixels<T> sums_about(Pixels<T>& of, const Rect& where, const Weight& weight) {
    constexpr int kR = kShrinkageRadius_px;
    const Rect& from = of.where();
    Pixels<T> rows({where.x0, from.y0, where.x1, from.y1}), out(where);
    for (int y = from.y0; y < from.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x)
            for (int u = std::max(x - kR, from.x0); u <= std::min(x + kR, from.x1 - 1); ++u)
                rows(x, y) += of(u, y) * weight(u - x);
    for (int y = where.y0; y < where.y1; ++y)
        for (int v = std::max(y - kR, from.y0); v <= std::min(y + kR, from.y1 - 1); ++v)
            for (int x = where.x0; x < where.x1; ++x) out(x, y) += rows(x, v) * weight(v - y);
    return out;
}

constexpr double tent(int distance_px) {
    return 1 - double(distance_px < 0 ? -distance_px : distance_px) / (kShrinkageRadius_px + 1);
}

}  // namespace

// A pixel has a part in its own shares: by that its error would look too small. What goes to the
// error is what the other pixels say, p, and the rest of the way by the other half's estimate.
void shrink_tile(const Film& film, const HalfEstimates& estimates, const Rect& tile,
                 Denoised& out) {
    const Rect near = grown(tile, kShrinkageRadius_px, estimates.pixels),
               far = grown(near, kShrinkageRadius_px, estimates.pixels);
    const auto each = [](const Rect& r, const auto& use) {
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) use(x, y);
    };
    Pixels<V3d> estimate(far);
    each(far, [&](int x, int y) {
        const size_t at = estimates.offset(x, y);
        estimate(x, y) = V3d(estimates.colour[0][at]) + V3d(estimates.colour[1][at]);
    });
    Pixels<V3d> brightness = sums_about(estimate, near, [](int) { return 1.; });
    Pixels<WayShares> shares(near);
    each(near, [&](int x, int y) {
        // Errors count as shares of the brightness about a pixel, but for a factor.
        const double square = brightness(x, y).length2();
        if (film.sample_count(x, y) >= kHalves && square > 0)
            shares(x, y) = shares_of(halves_of(film, estimates, x, y)) * (1 / square);
    });
    Pixels<WayShares> sums = sums_about(shares, tile, tent);
    each(tile, [&](int x, int y) {
        V3f &colour = out.colour[out.offset(x, y)], &error = out.squared_error[out.offset(x, y)];
        if (film.sample_count(x, y) < kHalves) {  // one half knows nothing
            const V4f all = film.colour(x, y);
            colour = {all.x, all.y, all.z};
            error = colour * colour;
            return;
        }
        const PixelHalves p = halves_of(film, estimates, x, y);
        const double part = part_of(sums(x, y)), others = part_of(sums(x, y) - shares(x, y)),
                     own = part - others;
        for (int c = 0; c < 3; ++c) {
            const double a = p.a[c], b = p.b[c], to_a = p.of_a[c] - a, to_b = p.of_b[c] - b,
                         shown = (a + b + part * (to_a + to_b)) / 2;
            colour[c] = static_cast<float>(shown);
            // What is shown, times the truth: each half's part by what the other one knows.
            const double times_truth = a * b + others * (to_a * b + to_b * a) / 2 +
                                       own * (to_a * p.of_b[c] + to_b * p.of_a[c]) / 2;
            error[c] = static_cast<float>(a * b - 2 * times_truth + shown * shown);
        }
    });
}

}  // namespace petzval::integrator
