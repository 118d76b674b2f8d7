// SPDX-License-Identifier: Apache-2.0
// Figures of a wavefront: RMS, Strehl ratio, Zernike coefficients.
#pragma once

#include <array>
#include <vector>

#include "camera/waves/pupil_function.h"

namespace petzval::camera {

/// Wavefront about the image point on the film at which its RMS is least: the mean and the tilt are
/// taken out. Each part of the pupil weighs by its light.
struct WavefrontFigures {
    std::array<double, 2> image_mm{};
    double rms_mm = 0, peak_to_valley_mm = 0;
    /// Light at that point over that of the same pupil without aberrations.
    double strehl = 0;
    /// f-number of the round pupil whose direction cosines cover the same area: its Airy disc is as
    /// large as the lens's would be.
    double fnumber = 0;
};
/// Figures of a pupil function that lets light through.
[[nodiscard]] WavefrontFigures wavefront_figures(const PupilFunction&);

/// Radius of the first dark ring of Airy's disc, mm: j / pi * wavelength * f-number, j = 3.8317 the
/// first zero of Bessel's J1. Born and Wolf 1999, Principles of Optics, sec. 8.5.2.
[[nodiscard]] double airy_radius_mm(double nm, double fnumber);

/// Zernike polynomials in the order of Noll 1976, J. Opt. Soc. Am. 66, 207, whose mean square over
/// the unit circle is 1: j from 1 (piston); 2, 3 tilt along x, y; 4 defocus; 11 spherical.
[[nodiscard]] double zernike(int j, double x, double y);
/// Coefficients of polynomials 1 to `count` that come nearest to the opd, mm: least squares, each
/// part of the pupil by its light. The unit circle is the rim of the stop, at any field. Zeros
/// where the pupil is too narrow to tell them apart.
[[nodiscard]] std::vector<double> zernike_coefficients_mm(const PupilFunction&, int count);

}  // namespace petzval::camera
