// SPDX-License-Identifier: Apache-2.0
// What the four lanes of a sample mean, and how RGB numbers of a scene reach them.
#pragma once

#include "core/lanes.h"

namespace petzval {

/// Three numbers relative to linear sRGB (Rec. 709 primaries, D65) in lanes 0 to 2; lane 3 is 0.
struct Rgb {
    f4 v{};

    Rgb() = default;
    explicit Rgb(f4 rgb0) : v(rgb0) {}
    Rgb(float r, float g, float b) : v{r, g, b, 0.f} {}
    explicit Rgb(float grey) : v{grey, grey, grey, 0.f} {}
    [[nodiscard]] float operator[](int i) const { return v[i]; }
    friend Rgb operator*(Rgb a, Rgb b) { return Rgb(a.v * b.v); }
    friend Rgb operator*(Rgb a, float b) { return Rgb(a.v * b); }
    friend Rgb operator+(Rgb a, Rgb b) { return Rgb(a.v + b.v); }
    Rgb& operator+=(Rgb b) { return *this = *this + b; }
};

/// Relative luminance of linear sRGB: second row of IEC 61966-2-1:1999's RGB to XYZ matrix.
[[nodiscard]] inline float luminance(Rgb c) {
    return 0.2126f * c.v[0] + 0.7152f * c.v[1] + 0.0722f * c.v[2];
}

/// Meaning of the lanes of one sample. Nothing but core/spectrum and core/colour looks inside.
struct Bands {
    f4 nm{};   ///< sampled wavelengths; unused while the lanes carry linear RGB
    f4 pdf{};  ///< density of each wavelength, 1/nm; 1 for RGB
    m4 on{};   ///< lanes in use

    /// Lanes 0 to 2 carry linear R, G and B.
    [[nodiscard]] static Bands rgb() { return {f4{}, f4{1, 1, 1, 1}, m4{-1, -1, -1, 0}}; }
};

/// Reflectance, transmittance or any other share of light (0 to 1), lane by lane.
[[nodiscard]] inline f4 uplift_reflectance(Rgb c, const Bands&) {
    return c.v;
}
/// Radiance of a source, lane by lane; an Rgb of 1 is 1 nit of the white point.
[[nodiscard]] inline f4 uplift_radiance(Rgb c, const Bands&) {
    return c.v;
}
/// The same number in every lane that is on.
[[nodiscard]] inline f4 uniform(float a, const Bands& bands) {
    return zero_off(bands.on, splat(a));
}

}  // namespace petzval
