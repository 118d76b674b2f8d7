// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/diffraction_pattern.h"

#include <algorithm>
#include <complex>
#include <kissfft/kissfft.hh>
#include <numbers>

namespace petzval::camera {
namespace {

using Complex = std::complex<double>;

/// Radius of the table in periods of the finest fringe, and cells for each. A mask has no edges
/// that tell how it goes on: its table is wider, and coarser.
struct Extent {
    int periods, cells;
};
constexpr Extent kOfOutline{24, 8}, kOfMask{64, 4};

double sinc(double x) {
    const double a = std::numbers::pi * x;
    return std::fabs(a) < 1e-6 ? 1 : std::sin(a) / a;
}

/// |F|^2 at frequencies (i - reach) steps along x and y; i below 2 reach + 1.
std::vector<double> transform(const DiffractingPupil& pupil, int reach, int cells) {
    const auto side = size_t(pupil.side), n = side * size_t(cells), width = 2 * size_t(reach) + 1;
    const kissfft<double> fft(n, false);
    std::vector<Complex> in(n), out(n), rows(side * width);
    const auto place = [&](size_t i) { return (i + n - size_t(reach)) % n; };
    for (size_t row = 0; row < side; ++row) {
        std::fill(in.begin(), in.end(), Complex());
        std::copy_n(&pupil.amplitude[row * side], side, in.begin());
        fft.transform(in.data(), out.data());
        for (size_t i = 0; i < width; ++i) rows[row * width + i] = out[place(i)];
    }
    std::vector<double> share(width * width);
    std::fill(in.begin(), in.end(), Complex());
    for (size_t i = 0; i < width; ++i) {
        for (size_t row = 0; row < side; ++row) in[row] = rows[row * width + i];
        fft.transform(in.data(), out.data());
        for (size_t j = 0; j < width; ++j) share[j * width + i] = std::norm(out[place(j)]);
    }
    return share;
}

}  // namespace

// A cell of the pupil is even: its own transform, a sinc, is taken off again.
DiffractionPattern::DiffractionPattern(const DiffractingPupil& pupil) {
    const auto [periods, cells] = pupil.has_outline ? kOfOutline : kOfMask;
    const int reach = periods * cells;
    const auto width = 2 * size_t(reach) + 1;
    const double side_mm = pupil.side * pupil.cell_mm, step = 1 / (side_mm * cells);
    const std::vector<double> squares = transform(pupil, reach, cells);
    std::vector<float> shares(width * width, 0.f);
    double near = 0;
    size_t used = 0;
    for (size_t j = 0; j < width; ++j)
        for (size_t i = 0; i < width; ++i) {
            const double x = double(i) - reach, y = double(j) - reach;
            if (x * x + y * y > double(reach) * reach) continue;
            const double own = sinc(x * step * pupil.cell_mm) * sinc(y * step * pupil.cell_mm);
            const double share = squares[j * width + i] * std::pow(pupil.cell_mm, 4) /
                                 (own * own * pupil.area_mm2) * step * step;
            shares[j * width + i] = static_cast<float>(share);
            near += share;
            ++used;
        }
    near_ = Piecewise2D(shares, uint32_t(width), uint32_t(width));
    step_ = static_cast<float>(step);
    half_ = static_cast<float>((reach + 0.5) * step);
    far_share_ = static_cast<float>(std::clamp(1 - near, 0., 1.));
    near_density_ = static_cast<float>((1 - double(far_share_)) / (step * step));
    const double radius = step * std::sqrt(double(used) / std::numbers::pi);
    // Of what lies beyond, edges of which nothing is known have what the others leave.
    constexpr double known = 0.05;
    double length = 0;
    for (const EdgeRun& run : pupil.runs) length += run.length;
    const double all = 2 * sqr(kPi) * pupil.area_mm2 * radius * double(far_share_);
    const double even = all - length > known * length ? all - length : 0;
    far_ = FarPattern(pupil.runs, even, radius);
}

float DiffractionPattern::density(V2f v) const {
    const float far = far_share_ > 0 ? far_share_ * far_.density(v) : 0.f;
    const float x = (v.x + half_) / step_, y = (v.y + half_) / step_;
    if (!(x >= 0 && y >= 0 && x < float(near_.width()) && y < float(near_.height()))) return far;
    return far + near_density_ * near_.probability(uint32_t(x), uint32_t(y));
}

}  // namespace petzval::camera
