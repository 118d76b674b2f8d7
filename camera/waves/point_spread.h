// SPDX-License-Identifier: Apache-2.0
// Point spread: the image of a point by waves, the contrast that it leaves, and the same by a
// direct sum.
#pragma once

#include <complex>
#include <span>

#include "camera/waves/pupil_function.h"

namespace petzval::camera {

/// Image of a point on a grid of the film. Sample (i, j) lies (i - side / 2, j - side / 2) steps
/// along x and y from the image point.
struct PointSpread {
    std::array<double, 2> image_mm{};
    double step_mm = 0;
    int side = 0;
    std::vector<double> share;  ///< of the light, on the square about each sample, row by row

    /// Light per mm^2 at a place about the image point, linear between samples; 0 beyond them.
    [[nodiscard]] double per_mm2(double x_mm, double y_mm) const;
    [[nodiscard]] double offset_mm(size_t i) const {
        return step_mm * (static_cast<double>(i) - side / 2);
    }
};
/// Point spread of a pupil function by a fast Fourier transform. side: a power of 2, twice that of
/// the grid at least; the larger, the finer are the samples. It covers side * step_mm = wavelength
/// / PupilGrid::step of the film; light from beyond is folded in.
[[nodiscard]] PointSpread point_spread(const PupilFunction&, int side);

/// Light of a point spread along one axis, summed across: what the image of a line is.
struct LineSpread {
    double step_mm = 0;
    std::vector<double> share;
};
[[nodiscard]] LineSpread line_spread(const PointSpread&, Section along);

/// Optical transfer function about the image point: its modulus is the MTF. By a direct sum, so
/// that any frequency will do.
[[nodiscard]] std::complex<double> transfer(const LineSpread&, double cycles_per_mm);

/// Radii about their common image point that hold shares of the light of point spreads, each by
/// its weight, mm; weights add up to 1, and shares rise.
[[nodiscard]] std::vector<double> radii_of_shares_mm(std::span<const PointSpread>,
                                                     std::span<const double> weights,
                                                     std::span<const double> shares);

/// Light per mm^2 at points of the film (offsets from the image point), over all light of the
/// bundle: a direct sum of Huygens's wavelets from side x side patches of the reference sphere, at
/// their true distances. It shares with pupil_function() the trace and nothing else. Where the
/// exit pupil is at infinity, or in the film, a sphere of 1 m takes its place.
[[nodiscard]] std::vector<double> huygens_spread(const AimedBundle&, double film_mm,
                                                 std::array<double, 2> image_mm,
                                                 std::span<const std::array<double, 2>> offsets_mm,
                                                 int side);

}  // namespace petzval::camera
