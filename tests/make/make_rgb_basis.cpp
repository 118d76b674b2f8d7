// SPDX-License-Identifier: Apache-2.0
// Makes assets/spectra/rgb_basis.csv: reflectances of linear sRGB's red, green and blue that add up
// to 1 (Mallett and Yuksel 2019, "Spectral Primary Decomposition for Rendering with sRGB
// Reflectance", section 3, for other knots and a smoother measure).
//
//   make_rgb_basis > rgb_basis.csv
//
// A quadratic programme: red and blue at the knots are sought, green is what they leave of 1. The
// summed squares of second differences are least where each, under D65, is its own colour and
// nothing falls below 0. By alternating directions (Stellato et al. 2020, "OSQP: an operator
// splitting solver for quadratic programs", algorithm 1), and then exactly with what lies at a
// bound held there.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "core/spectrum/colorimetry.h"
#include "io/spectra/spectra.h"

namespace petzval {
namespace {

using Vector = std::vector<double>;
using Matrix = std::vector<Vector>;

constexpr int kStep_nm = 5, kKnots = (kLast_nm - kFirst_nm) / kStep_nm + 1;
constexpr int kUnknowns = 2 * kKnots, kBounded = 3 * kKnots, kRows = kBounded + 6;
// Flat where no eye sees; between the colours it moves nothing by more than 0.005.
constexpr double kFlatness = 1e-1;

// Solves by elimination with the largest pivot of a column.
Vector solve(Matrix a, Vector b) {
    const size_t n = b.size();
    for (size_t i = 0; i < n; ++i) {
        size_t pivot = i;
        for (size_t r = i + 1; r < n; ++r)
            if (std::fabs(a[r][i]) > std::fabs(a[pivot][i])) pivot = r;
        std::swap(a[i], a[pivot]);
        std::swap(b[i], b[pivot]);
        for (size_t r = i + 1; r < n; ++r) {
            const double f = a[r][i] / a[i][i];
            if (f == 0) continue;
            for (size_t c = i; c < n; ++c) a[r][c] -= f * a[i][c];
            b[r] -= f * b[i];
        }
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t c = i + 1; c < n; ++c) b[i] -= a[i][c] * b[c];
        b[i] /= a[i][i];
    }
    return b;
}

Matrix zeros(size_t rows, size_t columns) {
    return Matrix(rows, Vector(columns));
}

// Half the Hessian: squared differences of red, of blue, and of their sum (green's, but for sign).
Matrix roughness() {
    Matrix one = zeros(kKnots, kKnots);
    const auto add = [&](std::vector<std::pair<int, double>> terms, double weight) {
        for (const auto& [i, a] : terms)
            for (const auto& [j, b] : terms) one[size_t(i)][size_t(j)] += weight * a * b;
    };
    for (int i = 1; i + 1 < kKnots; ++i) add({{i - 1, 1}, {i, -2}, {i + 1, 1}}, 1);
    for (int i = 0; i + 1 < kKnots; ++i) add({{i, 1}, {i + 1, -1}}, kFlatness);
    Matrix p = zeros(kUnknowns, kUnknowns);
    for (size_t i = 0; i < kKnots; ++i)
        for (size_t j = 0; j < kKnots; ++j)
            for (size_t a = 0; a < 2; ++a)
                for (size_t b = 0; b < 2; ++b)
                    p[a * kKnots + i][b * kKnots + j] += one[i][j] * (a == b ? 2 : 1);
    return p;
}

// Rows that are bounded: red, blue and their sum in [0, 1]; then linear sRGB of red and of blue.
struct Constraints {
    Matrix a = zeros(kRows, kUnknowns);
    Vector low = Vector(kRows, 0.), high = Vector(kRows, 1.);
};

Constraints constraints() {
    Constraints c;
    for (size_t i = 0; i < kKnots; ++i) {
        c.a[i][i] = c.a[kKnots + i][kKnots + i] = 1;
        c.a[2 * kKnots + i][i] = c.a[2 * kKnots + i][kKnots + i] = 1;
    }
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    const V3d white = respond(xyz_bar, d65);
    const Matrix3 to_rgb = srgb_to_xyz(white / white.y).inverse();
    for (size_t knot = 0; knot < kKnots; ++knot) {
        SpectrumTable hat;  // the light that a reflectance of 1 at this knot alone reflects
        for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
            const double off = std::fabs(nm - kFirst_nm - double(knot) * kStep_nm) / kStep_nm;
            hat.at_nm(nm) = static_cast<float>(std::max(0., 1 - off));
        }
        V3d xyz(0.);
        for (size_t i = 0; i < hat.value.size(); ++i)
            for (int k = 0; k < 3; ++k)
                xyz[k] += double(hat.value[i]) * d65.value[i] * xyz_bar[size_t(k)].value[i];
        const V3d rgb = to_rgb * (xyz / white.y);
        for (int channel = 0; channel < 3; ++channel) {
            c.a[size_t(kBounded + channel)][knot] = rgb[channel];
            c.a[size_t(kBounded + 3 + channel)][kKnots + knot] = rgb[channel];
        }
    }
    for (size_t i = kBounded; i < kRows; ++i) c.low[i] = c.high[i] = 0;
    c.low[kBounded] = c.high[kBounded] = 1;          // red is (1, 0, 0)
    c.low[kBounded + 5] = c.high[kBounded + 5] = 1;  // blue is (0, 0, 1)
    return c;
}

Matrix inverse(const Matrix& a) {
    Matrix columns;
    for (size_t i = 0; i < a.size(); ++i) {
        Vector unit(a.size());
        unit[i] = 1;
        columns.push_back(solve(a, unit));
    }
    return columns;  // symmetric
}

Vector times(const Matrix& a, const Vector& x) {
    Vector y;
    for (const Vector& row : a) {
        double sum = 0;
        for (size_t i = 0; i < x.size(); ++i) sum += row[i] * x[i];
        y.push_back(sum);
    }
    return y;
}

// Multipliers of the constraints, near enough to tell which bounds are met.
Vector split(const Matrix& p, const Constraints& c) {
    constexpr double sigma = 1e-9, equality_weight = 1e4;
    constexpr int iterations = 40000;
    Vector rho(kRows, 0.02);
    for (size_t i = kBounded; i < kRows; ++i) rho[i] *= equality_weight;
    Matrix k = p;
    for (size_t i = 0; i < kUnknowns; ++i) {
        k[i][i] += sigma;
        for (size_t j = 0; j < kUnknowns; ++j)
            for (size_t r = 0; r < kRows; ++r) k[i][j] += rho[r] * c.a[r][i] * c.a[r][j];
    }
    const Matrix k_inverse = inverse(k);
    Vector x(kUnknowns), z(kRows), y(kRows);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        Vector right(kUnknowns);
        for (size_t r = 0; r < kRows; ++r) {
            const double pull = rho[r] * z[r] - y[r];
            for (size_t i = 0; i < kUnknowns; ++i) right[i] += c.a[r][i] * pull;
        }
        for (size_t i = 0; i < kUnknowns; ++i) right[i] += sigma * x[i];
        x = times(k_inverse, right);
        const Vector ax = times(c.a, x);
        for (size_t r = 0; r < kRows; ++r) {
            z[r] = std::clamp(ax[r] + y[r] / rho[r], c.low[r], c.high[r]);
            y[r] += rho[r] * (ax[r] - z[r]);
        }
    }
    return y;
}

// The exact minimum with the rows of `held` at the bounds that they press against.
Vector polish(const Matrix& p, const Constraints& c, const Vector& multiplier, double least) {
    std::vector<size_t> held;
    for (size_t r = 0; r < kRows; ++r)
        if (r >= kBounded || std::fabs(multiplier[r]) > least) held.push_back(r);
    const size_t n = kUnknowns + held.size();
    Matrix kkt = zeros(n, n);
    Vector right(n);
    for (size_t i = 0; i < kUnknowns; ++i)
        for (size_t j = 0; j < kUnknowns; ++j) kkt[i][j] = p[i][j];
    for (size_t h = 0; h < held.size(); ++h) {
        const size_t r = held[h], at = kUnknowns + h;
        for (size_t i = 0; i < kUnknowns; ++i) kkt[at][i] = kkt[i][at] = c.a[r][i];
        kkt[at][at] = -1e-13;
        right[at] = multiplier[r] > 0 ? c.high[r] : c.low[r];
    }
    Vector x = solve(kkt, right);
    x.resize(kUnknowns);
    return x;
}

void run() {
    const Matrix p = roughness();
    const Constraints c = constraints();
    const Vector y = split(p, c);
    const Vector x = polish(p, c, y, 1e-9);
    const Vector ax = times(c.a, x);
    double worst = 0;
    for (size_t r = 0; r < kRows; ++r)
        worst = std::max({worst, c.low[r] - ax[r], ax[r] - c.high[r]});
    fmt::print(stderr, "largest violation of a constraint: {:.3g}\n", worst);
    fmt::print(
        "# Reflectances of linear sRGB's red, green and blue (ITU-R BT.709 primaries, D65 white).\n"
        "# Unit: 1, at wavelengths in nm; straight lines between the rows. They add up to 1; each "
        "is\n"
        "# its own colour under D65 for the CIE 1931 observer, summed at 1 nm.\n"
        "# Source: made by tests/make/make_rgb_basis.cpp from cie1931.csv and d65.csv, after\n"
        "# Mallett and Yuksel 2019.\n"
        "wavelength_nm,red,green,blue\n");
    for (size_t i = 0; i < kKnots; ++i) {
        const double red = std::clamp(x[i], 0., 1.), blue = std::clamp(x[kKnots + i], 0., 1.);
        fmt::print("{},{:.9f},{:.9f},{:.9f}\n", kFirst_nm + kStep_nm * int(i), red,
                   std::max(0., 1 - red - blue), blue);
    }
}

}  // namespace
}  // namespace petzval

int main() {
    petzval::run();
}
