// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/half_tile.h"

namespace petzval::integrator {
namespace {

/// Radius of the squares in which pixels are lonely, and in which variances are shared.
constexpr int kRadius_px = 2;

// Calls use(i) for eight pixels at once, of those that are at least `margin` from the edge.
template <class Use>
void each_eight(int margin, const Use& use) {
    for (int y = margin; y < HalfTile::kSide - margin; ++y)
        for (int x = margin; x < HalfTile::kSide - margin; x += 8)
            use(y * HalfTile::kSide + std::min(x, HalfTile::kSide - margin - 8));
}

// Calls use(offset) for the pixels of a square, but for its centre.
template <class Use>
void each_neighbour(const Use& use) {
    for (int dy = -kRadius_px; dy <= kRadius_px; ++dy)
        for (int dx = -kRadius_px; dx <= kRadius_px; ++dx)
            if (dx != 0 || dy != 0) use(dy * HalfTile::kSide + dx);
}

f8 sum_of(const std::array<HalfTile::Plane, 3>& planes, int i) {
    return load8(&planes[0][size_t(i)]) + load8(&planes[1][size_t(i)]) +
           load8(&planes[2][size_t(i)]);
}

}  // namespace

HalfTile::HalfTile(const Film& film, V2i tile, uint32_t half) {
    read(film, tile, half);
    dim_lonely_pixels();
    share_variance();
}

void HalfTile::read(const Film& film, V2i tile, uint32_t half) {
    const Rect there = film.pixels();
    inside = {};
    for (Plane& plane : colour) plane = {};
    for (Plane& plane : variance) plane = {};
    for (Plane& plane : guide) plane = {};
    std::vector<float> of_pixel(film.spectral() ? static_cast<size_t>(film.spectral()->bins().count)
                                                : 0);
    bins.assign(of_pixel.size(), {});
    for (int y = 0; y < HalfTile::kSide; ++y)
        for (int x = 0; x < HalfTile::kSide; ++x) {
            const int film_x = tile.x + x - kReach, film_y = tile.y + y - kReach;
            if (film_x < there.x0 || film_x >= there.x1 || film_y < there.y0 || film_y >= there.y1)
                continue;
            const FilmHalves::Half from = film.half(film_x, film_y, half);
            const auto i = static_cast<size_t>(y * HalfTile::kSide + x);
            inside[i] = 1;
            for (size_t c = 0; c < 3; ++c) {
                colour[c][i] = from.colour[static_cast<int>(c)];
                variance[c][i] = from.variance[static_cast<int>(c)];
            }
            for (size_t g = 0; g < kGuideNumbers; ++g) guide[g][i] = from.guide[g];
            if (of_pixel.empty()) continue;
            half_bins(film, film_x, film_y, half, of_pixel.data());
            for (size_t b = 0; b < bins.size(); ++b) bins[b][i] = of_pixel[b];
        }
}

// A pixel that is brighter than all others about it but for one, and hangs on few samples, becomes
// as bright as the second one of them.
void HalfTile::dim_lonely_pixels() {
    constexpr float kFew = 6;
    Plane factor;
    factor.fill(1);
    each_eight(kRadius_px, [&](int i) {
        f8 first = splat8(0), second = splat8(0), neighbours = splat8(0);
        each_neighbour([&](int offset) {
            const f8 other = sum_of(colour, i + offset);
            neighbours += load8(&inside[size_t(i + offset)]);
            second = max(second, min(first, other));
            first = max(first, other);
        });
        const f8 own = sum_of(colour, i);
        const f8 deviation = sqrt(load8(&variance[0][size_t(i)])) +
                             sqrt(load8(&variance[1][size_t(i)])) +
                             sqrt(load8(&variance[2][size_t(i)]));
        const f8 share = min(splat8(1), second / max(own, splat8(1e-30f)));
        // k samples that are alike, and all others 0, have a mean of k variances. A frame of one or
        // two pixels has no second one.
        const m8 is_lonely = (kFew * deviation * deviation > own * own) & (neighbours > 1.f);
        store8(&factor[size_t(i)], is_lonely ? share : splat8(1));
    });
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < factor.size(); ++i) {
            colour[c][i] *= factor[i];
            variance[c][i] *= factor[i] * factor[i];
        }
    for (Plane& plane : bins)
        for (size_t i = 0; i < factor.size(); ++i) plane[i] *= factor[i];
}

// A pixel that no bright sample met does not know its variance: it takes that of pixels about it
// which may be as bright, within bounds. (Well spread samples have less variance than independent
// ones. To scale it by what two parts of the samples say made the pictures no better.)
void HalfTile::share_variance() {
    constexpr float kDeviations = 9, kAlike = 0.25f;  // squares: three deviations, or half as much
    constexpr float kMost = 16;                       // times its own, or less
    const auto found = variance;
    each_eight(2 * kRadius_px, [&](int i) {
        std::array<f8, 3> own, sum{};
        f8 bright = splat8(0), count = splat8(0);
        for (size_t c = 0; c < 3; ++c) {
            own[c] = load8(&colour[c][size_t(i)]);
            bright += own[c] * own[c];
        }
        const f8 noise = sum_of(found, i);
        const auto add = [&](int offset) {
            const auto at = static_cast<size_t>(i + offset);
            f8 apart = splat8(0);
            for (size_t c = 0; c < 3; ++c) {
                const f8 e = own[c] - load8(&colour[c][at]);
                apart += e * e;
            }
            const f8 both = noise + sum_of(found, i + offset);
            const f8 weight =
                apart > kDeviations * both + kAlike * bright ? splat8(0) : load8(&inside[at]);
            count += weight;
            for (size_t c = 0; c < 3; ++c) sum[c] += weight * load8(&found[c][at]);
        };
        add(0);
        each_neighbour(add);
        for (size_t c = 0; c < 3; ++c) {
            const f8 shared = sum[c] / max(count, splat8(1)), self = load8(&found[c][size_t(i)]);
            store8(&variance[c][size_t(i)], min(max(shared, (1 / kMost) * self), kMost * self));
        }
    });
}

}  // namespace petzval::integrator
