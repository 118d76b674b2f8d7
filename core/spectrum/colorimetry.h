// SPDX-License-Identifier: Apache-2.0
// Colorimetry: sRGB and XYZ, chromatic adaptation, colour differences.
#pragma once

#include <array>

#include "core/math/math.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval {

/// 3 x 3 matrix by rows; applied to columns.
struct Matrix3 {
    std::array<V3d, 3> row;

    [[nodiscard]] V3d operator*(const V3d& v) const {
        return {row[0].dot(v), row[1].dot(v), row[2].dot(v)};
    }
    [[nodiscard]] Matrix3 operator*(const Matrix3&) const;
    [[nodiscard]] Matrix3 inverse() const;  ///< the matrix must not be singular
};

/// Three responses: sums over wavelengths of a spectrum under three curves.
[[nodiscard]] V3d respond(const std::array<SpectrumTable, 3>& curves, const SpectrumTable&);

/// Matrix from linear sRGB to XYZ for the chromaticities of ITU-R BT.709-6, scaled so that RGB (1,
/// 1, 1) is `white`. With the white of summed tables, which differ from D65's rounded chromaticity
/// in the fifth digit, white stays exactly white.
[[nodiscard]] Matrix3 srgb_to_xyz(const V3d& white);

/// Chromatic adaptation by Bradford: matrix from XYZ under one white to XYZ that look the same
/// under another. Lam 1985, "Metamerism and colour constancy"; matrix as in ICC.1:2022, annex E.
[[nodiscard]] Matrix3 bradford(const V3d& from_white, const V3d& to_white);

/// CIE 1976 L*a*b*: CIE 015:2018, 8.2.1.
[[nodiscard]] V3d xyz_to_lab(const V3d& xyz, const V3d& white);
/// CIEDE2000 with weights of 1. Sharma, Wu and Dalal 2005, "The CIEDE2000 Color-Difference
/// Formula", equations 2 to 22.
[[nodiscard]] double delta_e_2000(const V3d& lab1, const V3d& lab2);

}  // namespace petzval
