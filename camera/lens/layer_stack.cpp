// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/layer_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "camera/lens/coating.h"

namespace petzval::camera {
namespace {

using Complex = std::complex<double>;

// Oxides of zirconium, as evaporated, at 550 nm.
constexpr double kZirconiaIndex = 2.05;

Complex nonzero(Complex a) {
    constexpr double least = 1e-9;
    return std::norm(a) < least * least ? Complex(least) : a;
}

// A wave in a medium.
struct Wave {
    Complex index;
    Complex times_cosine;  ///< index times the cosine of the ray

    // sine2: square of the sine before, times the square of the index there. Waves die out along
    // the light.
    Wave(Complex n, double sine2) : index(n) {
        const Complex square = n * n - sine2;
        if (square.imag() == 0 && square.real() > 0) {
            times_cosine = nonzero(std::sqrt(square.real()));
        } else {
            const Complex root = nonzero(std::sqrt(square));
            times_cosine = root.imag() > 0 ? -root : root;
        }
    }
    [[nodiscard]] Complex admittance(bool s) const {
        return s ? times_cosine : index * index / times_cosine;
    }
};

// Electric and magnetic field at a boundary, up to a factor; of s and p.
struct Fields {
    Complex b = 1, c;
    double left = 1;  ///< of T, where b and c were made smaller

    void cross(Complex y, Complex cosine, Complex i_sine) {
        const Complex next_b = cosine * b + i_sine / y * c, next_c = y * i_sine * b + cosine * c;
        const double scale2 = std::norm(next_b) + std::norm(next_c), down = 1 / std::sqrt(scale2);
        b = next_b * down;
        c = next_c * down;
        left /= scale2;
    }
};

}  // namespace

SurfaceShares surface_shares(const LayerStack& layers, bool reversed, const Incidence& in) {
    if (!(in.cosine > 0)) return {1, 0};
    const double sine2 = in.index_from * in.index_from * (1 - in.cosine * in.cosine);
    const double um2 = 1e-6 * in.nm * in.nm;
    const Wave behind(in.index_into, sine2);
    std::array<Fields, 2> both;
    for (size_t p = 0; p < 2; ++p) both[p].c = behind.admittance(p == 0);
    for (size_t i = layers.size(); i-- > 0;) {
        const Layer& layer = layers[reversed ? layers.size() - 1 - i : i];
        if (layer.thickness_nm == 0) continue;
        const Wave wave({layer.index + layer.cauchy_um2 / um2, -layer.extinction}, sine2);
        const Complex phase = 2 * std::numbers::pi * layer.thickness_nm / in.nm * wave.times_cosine;
        // Opaque long before this.
        const double x = phase.real(), decay = std::min(-phase.imag(), 300.);
        Complex cosine = std::cos(x), i_sine(0, std::sin(x));
        if (decay != 0) {
            const double cosh = std::cosh(decay), sinh = std::sinh(decay);
            i_sine = {cosine.real() * sinh, i_sine.imag() * cosh};
            cosine = {cosine.real() * cosh, std::sin(x) * sinh};
        }
        for (size_t p = 0; p < 2; ++p) both[p].cross(wave.admittance(p == 0), cosine, i_sine);
    }
    SurfaceShares out{0, 0};
    for (size_t p = 0; p < 2; ++p) {
        const auto& [b, c, left] = both[p];
        // Their ratio is the admittance before.
        const double x = p == 0 ? in.index_from * in.cosine : in.index_from;
        const double z = p == 0 ? 1 : in.cosine;
        const double sum2 = std::norm(x * b + z * c);
        const double reflected = std::clamp(std::norm(x * b - z * c) / sum2, 0., 1.);
        const double y = std::max(behind.admittance(p == 0).real(), 0.);
        out.reflected += reflected / 2;
        out.transmitted += std::clamp(4 * x * z * y * left / sum2, 0., 1 - reflected) / 2;
    }
    return out;
}

LayerStack layers_of(Coating coating, double glass) {
    const double outer = kMgF2Index, inner = kZirconiaIndex;
    const auto layer = [](double index, double waves) {
        return Layer{waves * kQuarterWave_nm / index, index};
    };
    const double outer2 = outer * outer, inner2 = inner * inner;
    switch (coating) {
        case Coating::VCoat: {
            if (glass >= outer2 || glass <= 1) break;
            const double common = (glass - 1) / (outer2 * glass - inner2);
            const double to_inner = inner2 - glass, to_outer = glass - outer2;
            const auto waves = [](double tan2) {
                return std::atan(std::sqrt(tan2)) / (2 * std::numbers::pi);
            };
            return {layer(outer, 0.5 - waves(common * outer2 * to_inner / to_outer)),
                    layer(inner, waves(common * inner2 * to_outer / to_inner))};
        }
        case Coating::Broadband:
            return {layer(outer, 0.25), layer(inner, 0.5), layer(outer * std::sqrt(glass), 0.25)};
        case Coating::MgF2:
            break;
        default:
            return {};
    }
    return {layer(outer, 0.25)};
}

}  // namespace petzval::camera
