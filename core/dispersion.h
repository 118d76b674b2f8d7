// SPDX-License-Identifier: Apache-2.0
// How the refractive index of a glass depends on wavelength: for scenes and for lenses alike.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "core/lanes.h"

namespace petzval {

/// Fraunhofer lines of the catalogues, nm in air: helium d, hydrogen F and C (ISO 7944:1998).
inline constexpr double kLineD_nm = 587.5618, kLineF_nm = 486.1327, kLineC_nm = 656.2725;

/// n^2 = 1 + sum b w^2 / (w^2 - c), w in um, c in um^2. Sellmeier 1871; constant: an addend that
/// some catalogues use.
struct Sellmeier {
    std::vector<std::array<double, 2>> terms;  ///< {b, c}
    double constant = 0;
};
/// n^2 = sum a w^p, w in um, p even: Schott's of before 1992 has p = 0, 2, -2, -4, -6, -8.
struct PowerSeries {
    std::vector<std::array<double, 2>> terms;  ///< {a, p}
};
/// n = a + b / w^2, w in um. Cauchy 1836.
struct Cauchy {
    double a, b;
};
/// n at wavelengths in rising order, joined by straight lines; at least one.
struct IndexTable {
    std::vector<std::array<double, 2>> points;  ///< {nm, n}
};

/// Index relative to air. Outside the range of its formula the value at the range's end is held.
struct Glass {
    std::string name;
    std::variant<Sellmeier, PowerSeries, Cauchy, IndexTable> formula;
    double first_nm = 0, last_nm = 1e9;  ///< range that the formula was fitted to

    [[nodiscard]] double index(double nm) const;
    [[nodiscard]] f4 index(f4 nm) const;
    /// (nd - 1) / (nF - nC); infinite where nothing disperses.
    [[nodiscard]] double abbe() const;
};

/// Through nd with nF - nC = (nd - 1) / abbe. KHR_materials_dispersion's own formula.
[[nodiscard]] Cauchy cauchy_through(double nd, double abbe);

}  // namespace petzval
