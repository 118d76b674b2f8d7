// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/way_sums.h"

#include <algorithm>

#include "core/film/grown.h"
#include "core/spectrum/bands.h"
#include "integrator/denoise/denoise.h"
#include "integrator/denoise/pixel_halves.h"

namespace petzval::integrator {
namespace {

using Imath::V3d;

/// What squared errors of R, G and B of a pixel are multiplied by, so that they are relative ones:
/// about one over its squared brightness, nits^-2.
using Scale = V3d;

// The picture is M = (A + B) / 2, an estimate E = (D(A) + D(B)) / 2, the truth T. M + sum of
// part (E - M) has the least squared error where, for each E, the sum of part (E - M) (E' - M) is
// the mean of (M - T) (M - E'). The noise of the halves is independent, so that is the mean of
// (A - B) (A - B - D'(A) + D'(B)) / 4. It is shrinkage as of Stein (1956), towards estimates that
// are noisy too.
WaySums way_sums_of(const PixelHalves& p, const Scale& scale) {
    const V3d apart = (p.a - p.b) * scale;
    std::array<V3d, kEstimates> way;
    for (size_t e = 0; e < kEstimates; ++e) way[e] = (p.of_a[e] + p.of_b[e]) / 2 - p.samples();
    const auto gain = [&](size_t e) { return apart.dot(p.a - p.b - (p.of_a[e] - p.of_b[e])) / 4; };
    const auto product = [&](size_t e, size_t f) { return (way[e] * scale).dot(way[f]); };
    return {{gain(0), gain(1), product(0, 0), product(0, 1), product(1, 1)}};
}

// Means over the squares about the pixels of `where`, as far as `of` goes.
Pixels<V3d> means_about(const Pixels<V3d>& of, const Rect& where, int radius_px) {
    const Rect& from = of.where();
    Pixels<V3d> rows({where.x0, from.y0, where.x1, from.y1}), out(where);
    for (int y = from.y0; y < from.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x)
            for (int u = std::max(x - radius_px, from.x0); u < std::min(x + radius_px + 1, from.x1);
                 ++u)
                rows(x, y) += of(u, y);
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            const Rect square = grown({x, y, x + 1, y + 1}, radius_px, from);
            for (int v = square.y0; v < square.y1; ++v) out(x, y) += rows(x, v);
            out(x, y) /= double(square.width()) * square.height();
        }
    return out;
}

/// How bright pixels are.
struct Brightness {
    Pixels<double> luminance;  ///< tells which pixels are alike
    Pixels<Scale> scale;       ///< 0 where all is black

    explicit Brightness(const Rect& where) : luminance(where), scale(where) {}
};

// Estimates of 3 x 3 pixels tell how bright a pixel is. Where it is dark the light about counts a
// little: there an error is seen against it. Samples have no part in it: those that are dark by
// chance would be called alike, and their noise too small.
Brightness brightness_of(const HalfEstimates& estimates, const Rect& where) {
    constexpr double kAbout = 0.01, kSquareAbout = 0.01;
    const Rect further = grown(where, kBrightnessRadius_px, estimates.pixels);
    Pixels<V3d> light(further);
    for (int y = further.y0; y < further.y1; ++y)
        for (int x = further.x0; x < further.x1; ++x)
            for (const auto& half : estimates.colour)
                for (const auto& estimate : half)
                    light(x, y) += V3d(estimate[estimates.offset(x, y)]);
    const Pixels<V3d> near = means_about(light, where, 1),
                      about = means_about(light, where, kBrightnessRadius_px);
    const auto luminance_of = [](const V3d& rgb) {
        return std::max(0., double(luminance(Rgb(float(rgb.x), float(rgb.y), float(rgb.z)))));
    };
    Brightness out(where);
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            const V3d &n = near(x, y), &a = about(x, y);
            const V3d square = n * n + V3d(kSquareAbout * a.length2());
            out.luminance(x, y) = luminance_of(n) + kAbout * luminance_of(a);
            for (int c = 0; c < 3; ++c) out.scale(x, y)[c] = square[c] > 0 ? 1 / square[c] : 0;
        }
    return out;
}

WayPlanes way_planes(const Rect& where) {
    const Pixels<double> none(where);
    return {none, none, none, none, none};
}

constexpr double tent(int distance_px) {
    return 1 - double(distance_px < 0 ? -distance_px : distance_px) / (kShrinkageRadius_px + 1);
}

// Sums over the pixels about each of a tile. Nearer ones count more, and so do those that are
// nearly as bright: what is best for a lamp is not for the wall. The weight of a luminance b at one
// of a is 1 / (1 + (a - b)^2 / (c^2 a b)). For nearly equal ones (a - b)^2 / (a b) is the square of
// the logarithm of their ratio; beyond, it grows faster.
void sum_alike(const Pixels<double>& luminance, const WayPlanes& own, const Rect& tile,
               WayPlanes& out) {
    constexpr int kR = kShrinkageRadius_px;
    constexpr double kRatio = 0.3, kNotZero = 1e-300;
    const Rect& from = luminance.where();
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int v = std::max(y - kR, from.y0); v < std::min(y + kR + 1, from.y1); ++v)
            for (int dx = -kR; dx <= kR; ++dx) {
                const int x0 = std::max(tile.x0, from.x0 - dx),
                          count = std::min(tile.x1, from.x1 - dx) - x0;
                if (count <= 0) continue;
                const double near = tent(v - y) * tent(dx);
                const double* a = &luminance(x0, y);
                const double* b = a + ptrdiff_t(v - y) * from.width() + dx;
                std::array<double, kDenoiserTile_px> weight;
                for (int i = 0; i < count; ++i) {
                    const double alike = kRatio * kRatio * a[i] * b[i] + kNotZero;
                    weight[size_t(i)] = near * alike / (alike + (a[i] - b[i]) * (a[i] - b[i]));
                }
                for (size_t n = 0; n < WaySums::kNumbers; ++n) {
                    const double* add = &own[n](x0 + dx, v);
                    double* to = &out[n](x0, y);
                    for (int i = 0; i < count; ++i) to[i] += weight[size_t(i)] * add[i];
                }
            }
}

}  // namespace

WaysAbout::WaysAbout(const Film& film, const HalfEstimates& estimates, const Rect& tile)
    : own_(way_planes(grown(tile, kShrinkageRadius_px, estimates.pixels))),
      sums_(way_planes(tile)) {
    if (!estimates.can_choose) return;
    const Rect& around = own_[0].where();
    const Brightness brightness = brightness_of(estimates, around);
    for (int y = around.y0; y < around.y1; ++y)
        for (int x = around.x0; x < around.x1; ++x) {
            if (!has_both(film, x, y)) continue;
            const WaySums sums =
                way_sums_of(PixelHalves(film, estimates, x, y), brightness.scale(x, y));
            for (size_t n = 0; n < WaySums::kNumbers; ++n) own_[n](x, y) = sums.numbers[n];
        }
    sum_alike(brightness.luminance, own_, tile, sums_);
}

WaySums WaysAbout::all(int x, int y) const {
    WaySums out;
    for (size_t n = 0; n < WaySums::kNumbers; ++n) out.numbers[n] = sums_[n](x, y);
    return out;
}

WaySums WaysAbout::of_others(int x, int y) const {
    WaySums out;
    for (size_t n = 0; n < WaySums::kNumbers; ++n) out.numbers[n] = sums_[n](x, y) - own_[n](x, y);
    return out;
}

}  // namespace petzval::integrator
