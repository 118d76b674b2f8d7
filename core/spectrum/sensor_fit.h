// SPDX-License-Identifier: Apache-2.0
// The matrix that turns a camera's three numbers into linear sRGB.
#pragma once

#include <span>

#include "core/spectrum/colorimetry.h"

namespace petzval {

struct SensorFit {
    Matrix3 matrix;                              ///< sensor responses to linear sRGB
    double mean_delta_e = 0, worst_delta_e = 0;  ///< CIEDE2000 over the reflectances
};

/// Fit of the matrix by least squares over reflectances under a light, with the white of that light
/// exact. xyz_to_rgb: gives the target, from the eye's XYZ of the same reflectance. Throws
/// std::invalid_argument where the three curves do not tell three colours apart.
[[nodiscard]] SensorFit fit_sensor(const std::array<SpectrumTable, 3>& response,
                                   const std::array<SpectrumTable, 3>& xyz_bar,
                                   const SpectrumTable& light, const Matrix3& xyz_to_rgb,
                                   std::span<const SpectrumTable> reflectances);

}  // namespace petzval
