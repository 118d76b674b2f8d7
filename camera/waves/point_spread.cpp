// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/point_spread.h"

#include <algorithm>
#include <cmath>
#include <kissfft/kissfft.hh>
#include <numbers>
#include <stdexcept>

namespace petzval::camera {

// Samples and cells are numbered from their corners: the middle of the film's grid is reached by
// turning every second cell by half a wave; where the pupil's grid begins is a phase that no light
// shows.
PointSpread point_spread(const PupilFunction& pupil, int side) {
    using Complex = std::complex<double>;
    if (side < 2 * pupil.grid.side)
        throw std::invalid_argument("a point spread needs twice the cells of its pupil");
    const auto n = static_cast<size_t>(side), cells = static_cast<size_t>(pupil.grid.side);
    const kissfft<double> transform(n, true);
    std::vector<Complex> in(n), out(n), rows(cells * n);
    double light = 0;
    for (size_t row = 0; row < cells; ++row) {
        std::fill(in.begin(), in.end(), Complex());
        for (size_t column = 0; column < cells; ++column) {
            const size_t cell = row * cells + column;
            const double a = pupil.amplitude[cell];
            light += pupil.light[cell];
            const double turn = -2 * std::numbers::pi * pupil.opd_mm[cell] / pupil.wavelength_mm();
            in[column] = std::polar(1., turn) * ((row + column) % 2 == 0 ? a : -a);
        }
        transform.transform(in.data(), &rows[row * n]);
    }
    PointSpread spread{pupil.sphere.image_mm, pupil.wavelength_mm() / (pupil.grid.step * side),
                       side, std::vector<double>(n * n)};
    const double over = 1 / (light * static_cast<double>(n * n));
    std::fill(in.begin(), in.end(), Complex());
    for (size_t column = 0; column < n; ++column) {
        for (size_t row = 0; row < cells; ++row) in[row] = rows[row * n + column];
        transform.transform(in.data(), out.data());
        for (size_t row = 0; row < n; ++row)
            spread.share[row * n + column] = std::norm(out[row]) * over;
    }
    return spread;
}

double PointSpread::per_mm2(double x_mm, double y_mm) const {
    const double x = x_mm / step_mm + side / 2, y = y_mm / step_mm + side / 2;
    if (!(x >= 0 && y >= 0 && x < side - 1 && y < side - 1)) return 0;
    const auto i = static_cast<size_t>(x), j = static_cast<size_t>(y);
    const double u = x - double(i), v = y - double(j);
    const double* const low = &share[j * static_cast<size_t>(side) + i];
    const double* const high = low + side;
    return ((1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1])) /
           (step_mm * step_mm);
}

LineSpread line_spread(const PointSpread& spread, Section along) {
    const auto n = static_cast<size_t>(spread.side);
    LineSpread out{spread.step_mm, std::vector<double>(n)};
    for (size_t row = 0; row < n; ++row)
        for (size_t column = 0; column < n; ++column)
            out.share[along == Section::X ? column : row] += spread.share[row * n + column];
    return out;
}

std::complex<double> transfer(const LineSpread& line, double cycles_per_mm) {
    // The spread has no detail finer than two samples.
    if (!(std::fabs(cycles_per_mm) * 2 * line.step_mm < 1)) return 0;
    std::complex<double> sum;
    const double middle = static_cast<double>(line.share.size() / 2);
    for (size_t i = 0; i < line.share.size(); ++i)
        sum += std::polar(line.share[i], -2 * std::numbers::pi * cycles_per_mm * line.step_mm *
                                             (static_cast<double>(i) - middle));
    return sum;
}

std::vector<double> radii_of_shares_mm(std::span<const PointSpread> spreads,
                                       std::span<const double> weights,
                                       std::span<const double> shares) {
    std::vector<std::array<double, 2>> rings;
    for (size_t i = 0; i < spreads.size(); ++i) {
        const auto n = static_cast<size_t>(spreads[i].side);
        for (size_t cell = 0; cell < n * n; ++cell)
            rings.push_back(
                {std::hypot(spreads[i].offset_mm(cell % n), spreads[i].offset_mm(cell / n)),
                 weights[i] * spreads[i].share[cell]});
    }
    // A cell's light lies evenly between half a step before its middle and as much beyond.
    double step = 0;
    for (const PointSpread& spread : spreads) step = std::max(step, spread.step_mm);
    const auto within = [&](double radius_mm) {
        double sum = 0;
        for (const auto& [middle_mm, share] : rings)
            sum += share * std::clamp((radius_mm - middle_mm) / step + 0.5, 0., 1.);
        return sum;
    };
    std::vector<double> out;
    for (const double share : shares) {
        double low = 0, high = 0;
        for (const auto& ring : rings) high = std::max(high, ring[0] + step);
        for (int i = 0; i < 24; ++i) {
            const double middle = (low + high) / 2;
            (within(middle) < share ? low : high) = middle;
        }
        out.push_back((low + high) / 2);
    }
    return out;
}

}  // namespace petzval::camera
