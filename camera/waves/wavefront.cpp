// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/wavefront.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace petzval::camera {
namespace {

// Solves a x = b for a symmetric matrix above 0, by Cholesky's method; empty where it is not.
std::vector<double> solve_symmetric(std::vector<double> a, std::vector<double> b) {
    constexpr double least = 1e-12;  // of the diagonal
    const size_t n = b.size();
    for (size_t j = 0; j < n; ++j) {
        const double whole = a[j * n + j];
        for (size_t k = 0; k < j; ++k) a[j * n + j] -= square(a[j * n + k]);
        if (!(a[j * n + j] > least * whole)) return {};
        const double root = a[j * n + j] = std::sqrt(a[j * n + j]);
        for (size_t i = j + 1; i < n; ++i) {
            for (size_t k = 0; k < j; ++k) a[i * n + j] -= a[i * n + k] * a[j * n + k];
            a[i * n + j] /= root;
        }
    }
    for (size_t i = 0; i < n; ++i) {
        for (size_t k = 0; k < i; ++k) b[i] -= a[i * n + k] * b[k];
        b[i] /= a[i * n + i];
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t k = i + 1; k < n; ++k) b[i] -= a[k * n + i] * b[k];
        b[i] /= a[i * n + i];
    }
    return b;
}

// Coefficients with which the sum of functions of a cell is nearest to the opd, by its light.
template <class Functions>
std::vector<double> fit_opd(const PupilFunction& pupil, size_t count, const Functions& functions) {
    std::vector<double> matrix(count * count), right(count), value(count);
    for (size_t cell = 0; cell < pupil.amplitude.size(); ++cell) {
        const double light = pupil.light[cell];
        if (!(light > 0)) continue;
        functions(cell, value);
        for (size_t i = 0; i < count; ++i) {
            right[i] += light * value[i] * pupil.opd_mm[cell];
            for (size_t j = 0; j <= i; ++j) matrix[i * count + j] += light * value[i] * value[j];
        }
    }
    auto found = solve_symmetric(std::move(matrix), std::move(right));
    found.resize(count);
    return found;
}

// Zernike polynomial: norm times radial polynomial times cosine or sine of m angles.
struct ZernikeTerm {
    int m = 0;
    bool sine = false;
    std::vector<double> radial{};  ///< of r^m r^(2 k), norm included

    [[nodiscard]] double at(double x, double y) const {
        const double r2 = x * x + y * y;
        double sum = 0;
        for (size_t k = radial.size(); k-- > 0;) sum = sum * r2 + radial[k];
        std::complex<double> turned = 1;  // r^m e^(i m angle)
        for (int i = 0; i < m; ++i) turned *= std::complex(x, y);
        return sum * (sine ? turned.imag() : turned.real());
    }
};

// Within a radial order |m| rises, and even numbers are cosines.
ZernikeTerm zernike_term(int j) {
    int n = 0, first = 1;
    while (first + n + 1 <= j) first += ++n;
    const int place = j - first;
    ZernikeTerm out{.m = n % 2 == 0 ? (place + 1) / 2 * 2 : place / 2 * 2 + 1};
    out.sine = out.m > 0 && j % 2 != 0;
    // (-1)^k (n - k)! / (k! ((n + m) / 2 - k)! ((n - m) / 2 - k)!) r^(n - 2 k), each from the one
    // before.
    const int more = (n + out.m) / 2, less = (n - out.m) / 2;
    double term = std::tgamma(n + 1) / (std::tgamma(more + 1) * std::tgamma(less + 1)) *
                  std::sqrt(out.m == 0 ? n + 1. : 2 * (n + 1.));
    out.radial.resize(static_cast<size_t>(less) + 1);
    for (int k = 0; k <= less; ++k) {
        out.radial[static_cast<size_t>(less - k)] = term;
        term *= -double(more - k) * (less - k) / ((k + 1) * double(n - k));
    }
    return out;
}

}  // namespace

double zernike(int j, double x, double y) {
    return zernike_term(j).at(x, y);
}

std::vector<double> zernike_coefficients_mm(const PupilFunction& pupil, int count) {
    std::vector<ZernikeTerm> terms;
    for (int j = 1; j <= count; ++j) terms.push_back(zernike_term(j));
    return fit_opd(pupil, terms.size(), [&](size_t cell, std::vector<double>& value) {
        for (size_t i = 0; i < value.size(); ++i)
            value[i] = terms[i].at(pupil.stop[cell][0], pupil.stop[cell][1]);
    });
}

WavefrontFigures wavefront_figures(const PupilFunction& pupil) {
    const double width = pupil.grid.step * pupil.grid.side;
    const auto middle = pupil.cosines(pupil.amplitude.size() / 2);
    const auto functions = [&](size_t cell, std::vector<double>& value) {
        const auto at = pupil.cosines(cell);
        value = {1, (at[0] - middle[0]) / width, (at[1] - middle[1]) / width};
    };
    const auto plane = fit_opd(pupil, 3, functions);
    WavefrontFigures out;
    double light = 0, mean_square = 0, amplitude = 0, least = INFINITY, most = -INFINITY;
    std::complex<double> field;
    std::vector<double> value;
    for (size_t cell = 0; cell < pupil.amplitude.size(); ++cell) {
        const double a = pupil.amplitude[cell];
        if (!(a > 0)) continue;
        functions(cell, value);
        const double opd_mm =
            pupil.opd_mm[cell] - plane[0] - plane[1] * value[1] - plane[2] * value[2];
        light += pupil.light[cell];
        amplitude += a;
        mean_square += pupil.light[cell] * square(opd_mm);
        field += std::polar(a, -2 * std::numbers::pi * opd_mm / pupil.wavelength_mm());
        least = std::min(least, opd_mm);
        most = std::max(most, opd_mm);
    }
    for (size_t k = 0; k < 2; ++k)
        out.image_mm[k] = pupil.sphere.image_mm[k] + plane[k + 1] / width;
    out.rms_mm = std::sqrt(mean_square / light);
    out.peak_to_valley_mm = most - least;
    out.strehl = std::norm(field) / square(amplitude);
    // Area of an even amplitude of the same light and the same sum.
    const double area = square(amplitude) / light * square(pupil.grid.step);
    out.fnumber = 0.5 / std::sqrt(area / std::numbers::pi);
    return out;
}

double airy_radius_mm(double nm, double fnumber) {
    constexpr double first_zero = 3.8317059702075125;  // of J1
    return first_zero / std::numbers::pi * nm * 1e-6 * fnumber;
}

}  // namespace petzval::camera
