// SPDX-License-Identifier: Apache-2.0
// Prints core/shading/thin_film_table.h: what the standard observer sees under D65, as linear sRGB,
// of a reflectance that is a wave in 1 / wavelength, exp(2 pi i path / wavelength). Run it as:
// make_thin_film > core/shading/thin_film_table.h
#include <complex>
#include <cstdio>
#include <numbers>

#include "core/spectrum/colorimetry.h"
#include "io/spectra/spectra.h"

namespace petzval {
namespace {

constexpr int kStep_nm = 40, kSteps = 241;
/// Wavelengths about which the three see: what is left of the wave then changes slowly.
constexpr double kCarrier_nm[3] = {610, 545, 460};

/// Sensitivities of linear sRGB to a reflectance under D65, each with the sum 1.
std::array<std::vector<double>, 3> sensitivities() {
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    const V3d white = respond(xyz_bar, d65);
    const Matrix3 to_srgb = srgb_to_xyz(white / white.y).inverse();
    std::array<std::vector<double>, 3> out;
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
        const double light = double(d65.at_nm(nm));
        const V3d rgb = to_srgb * V3d(double(xyz_bar[0].at_nm(nm)), double(xyz_bar[1].at_nm(nm)),
                                      double(xyz_bar[2].at_nm(nm)));
        for (int c = 0; c < 3; ++c) out[size_t(c)].push_back(light * rgb[c]);
    }
    for (auto& curve : out) {
        double sum = 0;
        for (const double value : curve) sum += value;
        for (double& value : curve) value /= sum;
    }
    return out;
}

void print() {
    const auto curves = sensitivities();
    std::printf(
        "// SPDX-License-Identifier: Apache-2.0\n"
        "// Made by tests/make/make_thin_film.cpp; do not edit.\n#pragma once\n\n"
        "namespace petzval {\n\n"
        "inline constexpr int kThinFilmSteps = %d;\n"
        "inline constexpr float kThinFilmStep_nm = %d;\n"
        "inline constexpr float kThinFilmCarrier_nm[3] = {%g, %g, %g};\n"
        "/// [optical path / kThinFilmStep_nm][R, G, B][real, imaginary].\n"
        "// clang-format off\n"
        "inline constexpr float kThinFilm[%d][3][2] = {\n",
        kSteps, kStep_nm, kCarrier_nm[0], kCarrier_nm[1], kCarrier_nm[2], kSteps);
    for (int i = 0; i < kSteps; ++i) {
        std::printf("{");
        for (size_t c = 0; c < 3; ++c) {
            std::complex<double> sum = 0;
            for (int nm = kFirst_nm; nm <= kLast_nm; ++nm)
                sum += curves[c][size_t(nm - kFirst_nm)] *
                       std::polar(1., 2 * std::numbers::pi * i * kStep_nm *
                                          (1. / nm - 1 / kCarrier_nm[c]));
            std::printf("{%.5ff,%.5ff}%s", sum.real(), sum.imag(), c < 2 ? "," : "},");
        }
        std::printf(i % 2 == 1 || i + 1 == kSteps ? "\n" : " ");
    }
    std::printf("};\n// clang-format on\n\n}  // namespace petzval\n");
}

}  // namespace
}  // namespace petzval

int main() {
    petzval::print();
}
