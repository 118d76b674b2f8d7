// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/shrinkage.h"

#include <algorithm>
#include <cmath>

#include "core/film/grown.h"
#include "integrator/denoise/half_tile.h"

namespace petzval::integrator {
namespace {

using Imath::V2d, Imath::V3d;

/// Two halves of a pixel, and what is estimated of each.
struct PixelHalves {
    V3d a, b;
    std::array<V3d, kEstimates> of_a, of_b;
};

PixelHalves halves_of(const Film& film, const HalfEstimates& estimates, int x, int y) {
    const size_t at = estimates.offset(x, y);
    PixelHalves out{V3d(film.half(x, y, 0).colour), V3d(film.half(x, y, 1).colour), {}, {}};
    for (size_t e = 0; e < kEstimates; ++e) {
        out.of_a[e] = V3d(estimates.colour[0][e][at]);
        out.of_b[e] = V3d(estimates.colour[1][e][at]);
    }
    return out;
}

/// Whether both halves of a pixel have samples: one alone knows nothing of its error.
bool has_both(const Film& film, int x, int y) {
    return film.half(x, y, 0).count > 0 && film.half(x, y, 1).count > 0;
}

/// What tells which parts of both ways leave the least squared error, as sums over pixels.
struct WaySums {
    V2d gain;                    ///< what of the error goes with each way
    double first, both, second;  ///< products of the ways

    explicit WaySums(double all) : gain(all), first(all), both(all), second(all) {}
    void add(const WaySums& o, double weight) {
        gain += o.gain * weight;
        first += o.first * weight, both += o.both * weight, second += o.second * weight;
    }
};
void add(V3d& sum, const V3d& to, double weight) {
    sum += to * weight;
}
void add(WaySums& sum, const WaySums& to, double weight) {
    sum.add(to, weight);
}

// The picture is M = (A + B) / 2, an estimate E = (D(A) + D(B)) / 2, the truth T. M + sum of
// part (E - M) has the least squared error where, for each E, the sum of part (E - M) (E' - M) is
// the mean of (M - T) (M - E'). The noise of the halves is independent, so that is the mean of
// (A - B) (A - B - D'(A) + D'(B)) / 4. It is shrinkage as of Stein (1956), towards estimates that
// are noisy too.
WaySums way_sums_of(const PixelHalves& p) {
    WaySums out(0);
    const V3d apart = p.a - p.b;
    std::array<V3d, kEstimates> way;
    for (size_t e = 0; e < kEstimates; ++e) {
        way[e] = (p.of_a[e] - p.a + p.of_b[e] - p.b) / 2;
        out.gain[static_cast<int>(e)] = apart.dot(apart - (p.of_a[e] - p.of_b[e])) / 4;
    }
    out.first = way[0].dot(way[0]), out.both = way[0].dot(way[1]), out.second = way[1].dot(way[1]);
    return out;
}

// Parts of both ways: none is negative, and together they are 1 at most. As they are cut at 1, the
// noise of the gain can only lower the parts of pixels for which 1 is best. A fifth more makes up
// for most of that.
V2d parts_of(const WaySums& s) {
    constexpr double kMore = 1.2;
    const V2d gain = kMore * s.gain;
    const auto share = [](double of, double all) {
        return all > 0 ? std::clamp(of / all, 0., 1.) : 0.;
    };
    const double determinant = s.first * s.second - s.both * s.both;
    if (determinant > 1e-6 * s.first * s.second) {
        const V2d inside =
            V2d(gain.x * s.second - gain.y * s.both, gain.y * s.first - gain.x * s.both) /
            determinant;
        if (inside.x >= 0 && inside.y >= 0 && inside.x + inside.y <= 1) return inside;
    }
    const auto error = [&](const V2d& p) {
        return s.first * p.x * p.x + 2 * s.both * p.x * p.y + s.second * p.y * p.y -
               2 * gain.dot(p);
    };
    const double to_first =
        share(gain.x - gain.y - s.both + s.second, s.first - 2 * s.both + s.second);
    V2d best(share(gain.x, s.first), 0);
    for (const V2d& edge : {V2d(0, share(gain.y, s.second)), V2d(to_first, 1 - to_first)})
        if (error(edge) < error(best)) best = edge;
    return best;
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
                add(rows(x, y), of(u, y), weight(u - x));
    for (int y = where.y0; y < where.y1; ++y)
        for (int v = std::max(y - kR, from.y0); v <= std::min(y + kR, from.y1 - 1); ++v)
            for (int x = where.x0; x < where.x1; ++x) add(out(x, y), rows(x, v), weight(v - y));
    return out;
}

constexpr double tent(int distance_px) {
    return 1 - double(distance_px < 0 ? -distance_px : distance_px) / (kShrinkageRadius_px + 1);
}

/// Shares that what a pixel shows has of its samples and of both estimates.
struct ShownShares {
    explicit ShownShares(const V2d& parts)
        : samples(std::max(0., 1 - parts.x - parts.y)), estimates{parts.x, parts.y} {}
    double samples;
    std::array<double, kEstimates> estimates;
};

// Bins take the shares of the colour, so that they are of the same light.
void shrink_bins(const Film& film, const HalfEstimates& estimates, const ShownShares& shares, int x,
                 int y, float* out) {
    std::array<std::vector<float>, kHalves> half;
    for (uint32_t h = 0; h < kHalves; ++h) {
        half[h].resize(estimates.bins_each);
        half_bins(film, x, y, h, half[h].data());
    }
    const size_t at = estimates.offset(x, y) * estimates.bins_each;
    for (size_t b = 0; b < estimates.bins_each; ++b) {
        double sum = shares.samples * (double(half[0][b]) + double(half[1][b])) / 2;
        for (size_t e = 0; e < kEstimates; ++e)
            sum += shares.estimates[e] *
                   (double(estimates.bins[0][e][at + b]) + double(estimates.bins[1][e][at + b])) /
                   2;
        out[b] = static_cast<float>(sum);
    }
}

// A pixel has a share in its own sums: by that its error would look too small. What goes to the
// error is what the other pixels say, and the rest of the way by the other half's estimate. That
// one is biased where it blurs, and the other half itself is not independent of the parts: what
// both differ by is in doubt.
void tell_error(const PixelHalves& p, const V3d& shown, const V2d& parts, const V2d& by_others,
                V3f& squared_error, V3f& doubt) {
    V3d times_truth = p.a * p.b;  // what is shown, times the truth: each half by the other one
    V3d doubted(0);
    for (size_t e = 0; e < kEstimates; ++e) {
        const double other = by_others[static_cast<int>(e)],
                     rest = parts[static_cast<int>(e)] - other;
        const V3d to_a = p.of_a[e] - p.a, to_b = p.of_b[e] - p.b;
        times_truth += other * (to_a * p.b + to_b * p.a) / 2 +
                       rest * (to_a * p.of_b[e] + to_b * p.of_a[e]) / 2;
        doubted += rest * (to_a * (p.of_b[e] - p.b) + to_b * (p.of_a[e] - p.a));
    }
    squared_error = V3f(p.a * p.b - 2. * times_truth + shown * shown);
    doubt = V3f(doubted);
}

}  // namespace

void shrink_tile(const Film& film, const HalfEstimates& estimates, const Rect& tile,
                 Denoised& out) {
    const Rect around = grown(tile, kShrinkageRadius_px, estimates.pixels),
               further = grown(around, kShrinkageRadius_px, estimates.pixels);
    const auto each = [](const Rect& r, const auto& use) {
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) use(x, y);
    };
    Pixels<V3d> light(further);
    each(further, [&](int x, int y) {
        const PixelHalves p = halves_of(film, estimates, x, y);
        light(x, y) = p.a + p.b + p.of_a[0] + p.of_b[0];
    });
    Pixels<V3d> brightness = sums_about(light, around, [](int) { return 1.; });
    Pixels<WaySums> own(around);
    each(around, [&](int x, int y) {
        // Errors count as shares of the brightness about a pixel, but for a factor.
        const double square = brightness(x, y).length2();
        if (has_both(film, x, y) && square > 0)
            own(x, y).add(way_sums_of(halves_of(film, estimates, x, y)), 1 / square);
    });
    Pixels<WaySums> sums = sums_about(own, tile, tent);
    each(tile, [&](int x, int y) {
        const size_t at = out.offset(x, y);
        float* bins = out.bins.data() + at * estimates.bins_each;
        if (!has_both(film, x, y)) {
            const V4f all = film.colour(x, y);
            out.colour[at] = {all.x, all.y, all.z};
            out.squared_error[at] = out.colour[at] * out.colour[at];
            out.doubt[at] = V3f(0);
            if (film.spectral())
                film.spectral()->bin_means(film.offset(x, y), film.sample_count(x, y), bins);
            return;
        }
        const PixelHalves p = halves_of(film, estimates, x, y);
        WaySums others = sums(x, y);
        others.add(own(x, y), -1);
        const bool can_choose =
            std::min(film.half(x, y, 0).count, film.half(x, y, 1).count) >= kLeastSamplesToChoose;
        const V2d parts = can_choose ? parts_of(sums(x, y)) : V2d(1, 0);
        const ShownShares shares(parts);
        V3d shown = shares.samples * (p.a + p.b) / 2;
        for (size_t e = 0; e < kEstimates; ++e)
            shown += shares.estimates[e] * (p.of_a[e] + p.of_b[e]) / 2;
        out.colour[at] = V3f(shown);
        tell_error(p, shown, parts, can_choose ? parts_of(others) : parts, out.squared_error[at],
                   out.doubt[at]);
        if (film.spectral()) shrink_bins(film, estimates, shares, x, y, bins);
    });
}

}  // namespace petzval::integrator
