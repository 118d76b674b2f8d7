// SPDX-License-Identifier: Apache-2.0
// Reflectances from RGB by the other way that renderers know: Jakob and Hanika 2019, "A
// Low-Dimensional Function Space for Efficient Spectral Upsampling". For comparison only.
#pragma once

#include <vector>

#include "core/spectrum/bands.h"
#include "core/spectrum/colorimetry.h"

namespace petzval::bench {

/// S(x) = 1/2 + x / (2 sqrt(1 + x^2)): equation 2.
[[nodiscard]] inline f4 sigmoid(f4 x) {
    return 0.5f + 0.5f * x / sqrt(1.f + x * x);
}
/// Reflectance, lane by lane. c: the coefficients of nm^2, nm and 1 in lanes 0 to 2 (equation 1).
[[nodiscard]] inline f4 sigmoid_reflectance(f4 c, const Bands& bands) {
    return sigmoid((bands.nm * c[0] + c[1]) * bands.nm + c[2]);
}

/// Finds the coefficients for a linear sRGB colour: least CIE Lab distance under a white light, by
/// Gauss-Newton steps (section 4), damped where a whole step does not help.
class SigmoidFit {
  public:
    SigmoidFit(const std::array<SpectrumTable, 3>& xyz_bar, const SpectrumTable& white);
    /// Coefficients in powers of (nm - kFirst_nm) / (kLast_nm - kFirst_nm); start: the same.
    [[nodiscard]] V3d fit(const V3d& rgb, const V3d& start) const;

  private:
    struct Response {
        V3d lab;
        Matrix3 gradient;  ///< a row for each of L*, a*, b*
    };
    [[nodiscard]] Response respond_to(const V3d& c) const;

    typedef double d4 __attribute__((vector_size(32)));
    /// Four nanometres side by side.
    struct Row {
        d4 place;                   ///< 0 to 1 over the range of nm
        std::array<d4, 3> xyz_bar;  ///< times the white light: they add up to white_, whose y is 1
    };
    std::array<Row, (kSpectrumSize + 3) / 4> rows_{};
    V3d white_{0.};
    Matrix3 rgb_to_xyz_;
};

/// The same polynomial in powers of nm, and back.
[[nodiscard]] f4 in_powers_of_nm(const V3d& c);
[[nodiscard]] V3d in_unit_range(f4 c);

/// Coefficients by the largest channel's index and value and by the ratios of the other two to it
/// (section 5): 3 x size^3 x 3 floats.
class SigmoidTable {
  public:
    SigmoidTable(int size, const SigmoidFit&);
    /// Coefficients in powers of nm, interpolated between eight; rgb in [0, 1].
    [[nodiscard]] f4 look_up(Rgb rgb) const;
    [[nodiscard]] size_t bytes() const { return coefficients_.size() * sizeof(float); }

  private:
    /// Three floats at the cell; the fourth lane is the next cell's.
    [[nodiscard]] f4 load(size_t cell) const;

    size_t size_;
    std::vector<float> scale_;  ///< values of the largest channel
    std::vector<float> coefficients_;
};

}  // namespace petzval::bench
