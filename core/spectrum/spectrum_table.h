// SPDX-License-Identifier: Apache-2.0
// Spectrum table: a quantity at every nanometre of the renderer's range.
#pragma once

#include <array>
#include <span>
#include <utility>

#include "core/math/lanes.h"

namespace petzval {

/// Wavelengths in air that paths carry: the range of the CIE's colour matching functions.
inline constexpr int kFirst_nm = 360, kLast_nm = 830;
inline constexpr int kSpectrumSize = kLast_nm - kFirst_nm + 1;

/// Values at 360, 361 ... 830 nm, linear in between.
struct SpectrumTable {
    std::array<float, kSpectrumSize> value{};

    /// Value at a wavelength; beyond an end, the end's.
    [[nodiscard]] float at(float nm) const;
    [[nodiscard]] f4 at(f4 nm) const { return f4{at(nm[0]), at(nm[1]), at(nm[2]), at(nm[3])}; }
    [[nodiscard]] float& at_nm(int nm) { return value[static_cast<size_t>(nm - kFirst_nm)]; }
    [[nodiscard]] float at_nm(int nm) const { return value[static_cast<size_t>(nm - kFirst_nm)]; }
};

/// Values of a table beyond the wavelengths that were measured.
enum class Extrapolate { Zero, Hold };

/// Table of (nm, value) points in rising order of nm, at least one, joined by straight lines.
[[nodiscard]] SpectrumTable tabulate(std::span<const std::pair<float, float>> points, Extrapolate);

/// Integral over nm of the straight lines, and of the product of two tables' straight lines: what
/// a render finds, and CIE 015:2018's summation at 1 nm but for curves that bend within 1 nm.
[[nodiscard]] double integral(const SpectrumTable&);
[[nodiscard]] double integral_of_product(const SpectrumTable&, const SpectrumTable&);

}  // namespace petzval
