// SPDX-License-Identifier: Apache-2.0
// Bands: the meaning of a sample's four lanes, and the maps from RGB numbers of a scene to them.
#pragma once

#include "core/math/lanes.h"

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

/// Meaning of the lanes of one sample: linear R, G, B in lanes 0 to 2, or a sampled wavelength in
/// each. Numbers of the scene come in, and the film's go out, by linear maps that are the same for
/// both. Code that scatters, adds or weighs light must not look inside; only code that turns a
/// function of wavelength into lanes, or lanes into bins, does (colour, illuminant, observer,
/// spectral_film, surface).
struct Bands {
    f4 nm{};                    ///< wavelengths in air; 0 while the lanes carry linear RGB
    f4 pdf{};                   ///< density of each wavelength, 1/nm; 1 for RGB
    m4 on{};                    ///< lanes in use
    f4 red{}, green{}, blue{};  ///< reflectance that is 1 in R, in G, in B
    f4 white{};                 ///< radiance of the white light at 1 nit, W/(m2 sr nm); 1 for RGB
    f4 to_r{}, to_g{}, to_b{};  ///< film's R, G, B for a unit of each lane
    bool spectral = false;      ///< nm holds wavelengths
    /// Lane of the hero wavelength (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"), along
    /// which a path goes where the lanes must part. Given the wavelengths, each lane is as likely
    /// to be the hero, and the lanes follow each other in the circle of quantiles (both by
    /// Observer::draw). The hero wavelength is stratified over a pixel's samples.
    int hero = 0;

    /// Bands whose lanes 0 to 2 carry linear R, G and B.
    [[nodiscard]] static Bands rgb() {
        const f4 r{1, 0, 0, 0}, g{0, 1, 0, 0}, b{0, 0, 1, 0};
        return {f4{}, f4{1, 1, 1, 1}, m4{-1, -1, -1, 0}, r, g, b, f4{1, 1, 1, 0}, r, g, b};
    }
};

/// Reflectance, transmittance or any other share of light (0 to 1), lane by lane. Linear, as in
/// Mallett and Yuksel 2019, "Spectral Primary Decomposition for Rendering with sRGB Reflectance".
[[nodiscard]] inline f4 uplift_reflectance(Rgb c, const Bands& bands) {
    return bands.red * c.v[0] + bands.green * c.v[1] + bands.blue * c.v[2];
}
/// Radiance of a source, lane by lane; an Rgb of 1 is 1 nit of the white point.
[[nodiscard]] inline f4 uplift_radiance(Rgb c, const Bands& bands) {
    return uplift_reflectance(c, bands) * bands.white;
}
/// Linear sRGB estimate of one sample, in nits of the white point.
[[nodiscard]] inline Rgb to_rgb(f4 radiance, const Bands& bands) {
    return {hsum(radiance * bands.to_r), hsum(radiance * bands.to_g), hsum(radiance * bands.to_b)};
}
/// Linear sRGB estimate of a reflectance under the white light.
[[nodiscard]] inline Rgb reflectance_to_rgb(f4 reflectance, const Bands& bands) {
    return to_rgb(reflectance * bands.white, bands);
}
/// The same number in every lane that is on.
[[nodiscard]] inline f4 uniform(float a, const Bands& bands) {
    return zero_off(bands.on, splat(a));
}

}  // namespace petzval
