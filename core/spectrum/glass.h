// SPDX-License-Identifier: Apache-2.0
// Refractive index of glasses by wavelength, for scenes and for lenses alike.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "core/math/lanes.h"

namespace petzval {

/// Fraunhofer lines of the catalogues, nm in air: helium d, hydrogen F and C (ISO 7944:1998).
inline constexpr double kLineD_nm = 587.5618, kLineF_nm = 486.1327, kLineC_nm = 656.2725;
/// Mercury g.
inline constexpr double kLineG_nm = 435.8343;

/// n^2 = 1 + sum b w^2 / (w^2 - c), w in um, c in um^2. Sellmeier 1871; constant: an addend that
/// some catalogues use.
struct Sellmeier {
    std::vector<std::array<double, 2>> terms;  ///< {b, c}
    double constant = 0;
    bool operator==(const Sellmeier&) const = default;
};
/// n^2 = sum a w^p, w in um, p even: Schott's formula before 1992 has p = 0, 2, -2, -4, -6, -8.
struct PowerSeries {
    std::vector<std::array<double, 2>> terms;  ///< {a, p}
    bool operator==(const PowerSeries&) const = default;
};
/// n = sum a w^p, w in um. Cauchy 1836 has p = 0, -2.
struct IndexSeries {
    std::vector<std::array<double, 2>> terms;  ///< {a, p}
    bool operator==(const IndexSeries&) const = default;
};
/// n at wavelengths in rising order, joined by straight lines; at least one.
struct IndexTable {
    std::vector<std::array<double, 2>> points;  ///< {nm, n}
    bool operator==(const IndexTable&) const = default;
};

/// Index relative to air. Outside the range of its formula the value at the range's end is held.
struct Glass {
    std::string name;
    std::variant<Sellmeier, PowerSeries, IndexSeries, IndexTable> formula;
    double first_nm = 0, last_nm = 1e9;  ///< range that the formula was fitted to
    /// Absorption {nm, 1/mm}, rising in nm, joined by straight lines and held beyond its ends;
    /// none: nothing is known of it, and the glass is clear.
    std::vector<std::array<double, 2>> absorption_per_mm{};

    [[nodiscard]] double index(double nm) const;
    [[nodiscard]] f4 index(f4 nm) const;
    /// Absorption at a wavelength, 1/mm: exp(-mm times it) of the light is left after a way in
    /// glass.
    [[nodiscard]] double absorption(double nm) const;
    /// Abbe number (nd - 1) / (nF - nC); infinite where nothing disperses.
    [[nodiscard]] double abbe() const;
    bool operator==(const Glass&) const = default;
};

/// Cauchy formula n = a + b / w^2 through nd with nF - nC = (nd - 1) / abbe: that of
/// KHR_materials_dispersion.
[[nodiscard]] IndexSeries cauchy_through(double nd, double abbe);

/// Index of a typical glass of which only nd and the Abbe number are known: n = a + b w^-1.5 + c
/// w^-4.5 through nd, nF - nC and the partial dispersion (ng - nF) / (nF - nC) = 0.505549 -
/// 0.000142809 abbe + 2.8816 / abbe that catalogue glasses have on average. The greatest error from
/// 400 to 700 nm is 1.7e-4 for half of them, at worst 1.8e-3. No dispersion where abbe is infinite.
[[nodiscard]] IndexSeries glass_like(double nd, double abbe);

}  // namespace petzval
