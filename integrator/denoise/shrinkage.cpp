// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/shrinkage.h"

#include <algorithm>

#include "integrator/denoise/half_tile.h"
#include "integrator/denoise/pixel_halves.h"
#include "integrator/denoise/way_sums.h"

namespace petzval::integrator {
namespace {

using Imath::V2d, Imath::V3d;

// Parts of both ways: none is negative, and together they are 1 at most. As they are cut at 1, the
// noise of the gain can only lower the parts of pixels for which 1 is best. A fifth more makes up
// for most of that.
V2d parts_of(const WaySums& s) {
    constexpr double kMore = 1.2;
    const V2d gain = kMore * s.gain();
    const double first = s.first(), both = s.both(), second = s.second();
    const auto share = [](double of, double all) {
        return all > 0 ? std::clamp(of / all, 0., 1.) : 0.;
    };
    const double determinant = first * second - both * both;
    if (determinant > 1e-6 * first * second) {
        const V2d inside =
            V2d(gain.x * second - gain.y * both, gain.y * first - gain.x * both) / determinant;
        if (inside.x >= 0 && inside.y >= 0 && inside.x + inside.y <= 1) return inside;
    }
    const auto error = [&](const V2d& p) {
        return first * p.x * p.x + 2 * both * p.x * p.y + second * p.y * p.y - 2 * gain.dot(p);
    };
    const double to_first = share(gain.x - gain.y - both + second, first - 2 * both + second);
    V2d best(share(gain.x, first), 0);
    for (const V2d& edge : {V2d(0, share(gain.y, second)), V2d(to_first, 1 - to_first)})
        if (error(edge) < error(best)) best = edge;
    return best;
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
// error is what the other pixels say (its own light tells how much each of them counts; of that no
// bias was found), and the rest of the way by the other half's estimate. That
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
    const WaysAbout ways(film, estimates, tile);
    const auto each = [](const Rect& r, const auto& use) {
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) use(x, y);
    };
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
        const PixelHalves p(film, estimates, x, y);
        const bool can_choose =
            std::min(film.half(x, y, 0).count, film.half(x, y, 1).count) >= kLeastSamplesToChoose;
        const V2d first_alone(1, 0);
        const V2d parts = can_choose ? parts_of(ways.all(x, y)) : first_alone;
        const ShownShares shares(parts);
        V3d shown = shares.samples * p.samples();
        for (size_t e = 0; e < kEstimates; ++e)
            shown += shares.estimates[e] * (p.of_a[e] + p.of_b[e]) / 2;
        out.colour[at] = V3f(shown);
        tell_error(p, shown, parts, can_choose ? parts_of(ways.of_others(x, y)) : first_alone,
                   out.squared_error[at], out.doubt[at]);
        if (film.spectral()) shrink_bins(film, estimates, shares, x, y, bins);
    });
}

}  // namespace petzval::integrator
