// SPDX-License-Identifier: Apache-2.0
#include "core/shading/thin_film.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "core/shading/microfacet.h"

namespace petzval {
namespace {

using Complex = std::complex<double>;

/// Reflectance of one film by characteristic matrices: Born and Wolf 1999, 1.6.2 and 1.6.4. It
/// shares no formula with the product, which adds up amplitudes.
double by_matrices(double cosine, double film, double thickness_nm, Complex base, double nm) {
    const double sin2 = 1 - cosine * cosine;
    const double cos_film = std::sqrt(1 - sin2 / (film * film));
    const Complex cos_base = std::sqrt(1. - sin2 / (base * base));
    const double beta = 2 * std::numbers::pi * film * thickness_nm * cos_film / nm;
    double sum = 0;
    for (const bool parallel : {false, true}) {
        // Admittances: n cos for the electric field across the plane of incidence, n / cos along
        // it.
        const auto admittance = [parallel](Complex n, Complex c) {
            return parallel ? n / c : n * c;
        };
        const Complex front = admittance(1, cosine), own = admittance(film, cos_film),
                      back = admittance(base, cos_base);
        // Time runs as exp(-i w t): the sine's sign follows n + ik.
        const Complex i(0, 1), m11 = std::cos(beta), m12 = -i * std::sin(beta) / own,
                               m21 = -i * std::sin(beta) * own, m22 = m11;
        const Complex b = m11 + m12 * back, c = m21 + m22 * back;
        sum += std::norm((front * b - c) / (front * b + c));
    }
    return sum / 2;
}

Bands wavelengths(f4 nm) {
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.on = m4{-1, -1, -1, -1};
    bands.nm = nm;
    return bands;
}

TEST(ThinFilm, IsThatOfCharacteristicMatrices) {
    const f4 nm{420, 510, 605, 700};
    for (const float film : {1.f, 1.33f, 1.8f, 2.5f})
        for (const float thickness_nm : {0.f, 90.f, 380.f, 1200.f})
            for (const Complex base : {Complex(1.5, 0), Complex(1.0001, 0), Complex(2.4, 0),
                                       Complex(0.43, 2.35), Complex(1.2, 7)})
                for (const float cosine : {0.02f, 0.3f, 0.7f, 1.f}) {
                    const f4 got = ThinFilm(film, thickness_nm, wavelengths(nm))
                                       .reflectance(cosine, splat(static_cast<float>(base.real())),
                                                    splat(static_cast<float>(base.imag())));
                    for (int i = 0; i < 4; ++i)
                        EXPECT_NEAR(double(got[i]),
                                    by_matrices(double(cosine), double(film), double(thickness_nm),
                                                base, double(nm[i])),
                                    2e-4)
                            << film << ' ' << thickness_nm << ' ' << base << ' ' << cosine << ' '
                            << nm[i];
                }
}

TEST(ThinFilm, WithoutThicknessIsTheBareBase) {
    for (const float cosine : {0.1f, 0.5f, 1.f})
        for (const Bands& bands : {Bands::rgb(), wavelengths(f4{400, 500, 600, 700})}) {
            const f4 bare = fresnel_dielectric(cosine, splat(1.7f));
            const f4 film = ThinFilm(1.3f, 0.f, bands).reflectance(cosine, splat(1.7f), f4{});
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(film[i], bare[i], 2e-3f) << cosine;
        }
}

// Behind the critical angle of the base nothing is let through, whatever the film.
TEST(ThinFilm, TotalReflectionStaysTotal) {
    for (const float thickness_nm : {50.f, 400.f})
        for (const Bands& bands : {Bands::rgb(), wavelengths(f4{400, 500, 600, 700})}) {
            const f4 inside =
                ThinFilm(1.3f / 1.5f, thickness_nm, bands).reflectance(0.6f, splat(1 / 1.5f), f4{});
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(inside[i], 1.f, 2e-3f) << thickness_nm;
        }
}

TEST(ThinFilm, IndexForReflectanceGivesThatReflectance) {
    const f4 f0{0.04f, 0.2f, 0.9f, 0.f};
    const f4 back = fresnel_dielectric(1.f, index_for_reflectance(f0));
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(back[i], f0[i], 1e-5f);
}

}  // namespace
}  // namespace petzval
