// SPDX-License-Identifier: Apache-2.0
// Prints core/shading/glass_loss_table.h: what single scattering loses on rough glass, by
// quadrature over the visible normals, fitted by least squares. Takes minutes. Run it as:
// make_glass_loss > core/shading/glass_loss_table.h
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

namespace {

constexpr int kIndices = 9, kRoughnesses = 12, kCosines = 14;
constexpr double kMostF = 0.75, kLeastRoughness = 0.0316227766, kKnee = 16;
/// What is fitted stands at so many places from node to node.
constexpr int kFiner = 4;
constexpr int kSteps = 96;
/// What the fit is off by at worst counts as loss rather than as gain, of which less is allowed.
constexpr double kLower = 0.0025;

struct Scattered {
    double all = 0, transmitted = 0;  ///< of 1, at specular 1
    double all_plain = 0;             ///< at specular 0, where only total reflection is left
};

double lambda(double cosine, double alpha) {
    const double tan2 = (1 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

// Of light that arrives at wo_z on the facet (mx, mz), per visible facet.
void scatter(double wo_z, double sin_o, double mx, double mz, double alpha, double eta,
             Scattered& sum) {
    const double cosine = sin_o * mx + wo_z * mz;
    if (cosine <= 0) return;
    const double cos2 = 1 - (1 - cosine * cosine) / (eta * eta);
    const double behind = std::sqrt(std::fmax(cos2, 0));
    const double p = (eta * cosine - behind) / (eta * cosine + behind);
    const double s = (cosine - eta * behind) / (cosine + eta * behind);
    const double reflectance = cos2 > 0 ? (p * p + s * s) / 2 : 1;
    const double up = 2 * cosine * mz - wo_z;
    if (up > 0) {
        const double lambda_o = lambda(wo_z, alpha);
        const double seen = (1 + lambda_o) / (1 + lambda_o + lambda(up, alpha));
        sum.all += reflectance * seen;
        if (cos2 <= 0) sum.all_plain += seen;
    }
    const double down = wo_z / eta - (cosine / eta - behind) * mz;
    if (cos2 > 0 && down > 0) {
        const double seen = 1 / (1 + lambda(down, alpha));
        sum.all += (1 - reflectance) * seen;
        sum.transmitted += (1 - reflectance) * seen;
        sum.all_plain += seen;
    }
}

// Midpoint rule in the unit square that the spherical-cap method maps onto the visible normals.
Scattered integrate(double wo_z, double alpha, double eta) {
    const double sin_o = std::sqrt(1 - wo_z * wo_z);
    const double length = std::hypot(alpha * sin_o, wo_z);
    const double sx = alpha * sin_o / length, sz = wo_z / length;
    Scattered sum;
    for (int i = 0; i < 2 * kSteps; ++i) {
        const double z = 1 - (i + 0.5) / (2 * kSteps) * (1 + sz);
        const double sin_theta = std::sqrt(std::fmax(0, 1 - z * z));
        for (int j = 0; j < kSteps; ++j) {  // the other half mirrors this one
            const double phi = std::numbers::pi * (j + 0.5) / kSteps;
            const double mx = (sin_theta * std::cos(phi) + sx) * alpha;
            const double my = sin_theta * std::sin(phi) * alpha;
            const double mz = std::fmax(z + sz, 1e-300);
            const double norm = std::sqrt(mx * mx + my * my + mz * mz);
            scatter(wo_z, sin_o, mx / norm, mz / norm, alpha, eta, sum);
        }
    }
    const double n = 2. * kSteps * kSteps;
    return {sum.all / n, sum.transmitted / n, sum.all_plain / n};
}

// Values at places along the axes, 0 to 1.
double index_at(double place) {
    const double f2 = std::pow(kMostF * place, 2);
    return (1 + f2) / (1 - f2);
}
double alpha_at(double place) {
    return std::pow(kLeastRoughness + (1 - kLeastRoughness) * place, 2);
}
double cosine_at(double place, double alpha) {
    const double knee = kKnee * alpha;
    return std::clamp(knee * place * place / (1 + knee - place * place), 1e-4 * alpha, 1.);
}

// Sizes: one value stands at [outer][axis][inner].
struct Axis {
    int outer, nodes, inner;
};

int places(int nodes) {
    return kFiner * (nodes - 1) + 1;
}

// Along one axis, values at places become values at nodes: of the function linear from node to node
// that fits them best.
std::vector<double> fit(const std::vector<double>& y, Axis axis,
                        const std::function<double(int)>& weight) {
    const int n = axis.nodes, size = places(n);
    std::vector<double> fitted(static_cast<size_t>(axis.outer * n * axis.inner));
    for (int line = 0; line < axis.outer * axis.inner; ++line) {
        const int outer = line / axis.inner, inner = line % axis.inner;
        std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0.));
        for (int i = 0; i < size; ++i) {
            const int j = std::min(i / kFiner, n - 2);
            const double f = static_cast<double>(i - j * kFiner) / kFiner, hat[2] = {1 - f, f};
            for (int p = 0; p < 2; ++p) {
                for (int q = 0; q < 2; ++q) a[j + p][j + q] += weight(i) * hat[p] * hat[q];
                a[j + p][n] += weight(i) * hat[p] * y[(outer * size + i) * axis.inner + inner];
            }
        }
        for (int k = 0; k < n; ++k)  // Gauss and Jordan; positive definite, so without pivots
            for (int i = 0; i < n; ++i) {
                const double factor = i == k ? 0 : a[i][k] / a[k][k];
                for (int j = k; factor != 0 && j <= n; ++j) a[i][j] -= factor * a[k][j];
            }
        for (int k = 0; k < n; ++k)
            fitted[(outer * n + k) * axis.inner + inner] = a[k][n] / a[k][k];
    }
    return fitted;
}

double place(int i, int nodes) {
    return i / (places(nodes) - 1.);
}

// Indices that are promised something count most.
double weight_of_index(int i) {
    const double index = index_at(place(i, kIndices));
    return index < 1.095 ? 0.02 : index < 2.5 ? 1 : 0.1;
}

// Losses at all places: [index][roughness][specular 1, 0][side][cosine].
std::vector<double> losses() {
    std::vector<double> lost;
    for (int i = 0; i < places(kIndices); ++i)
        for (int r = 0; r < places(kRoughnesses); ++r) {
            std::vector<double> plain;
            const double index = index_at(place(i, kIndices));
            const double alpha = alpha_at(place(r, kRoughnesses));
            for (const double eta : {index, 1 / index})
                for (int c = 0; c < places(kCosines); ++c) {
                    const double cosine = cosine_at(place(c, kCosines), alpha);
                    const Scattered s = integrate(cosine, alpha, eta);
                    lost.push_back(1 - s.all);
                    plain.push_back(1 - s.all_plain);
                }
            lost.insert(lost.end(), plain.begin(), plain.end());
        }
    return lost;
}

// Of what is scattered once, on average over the directions, the share that changes sides.
double crossing(double index, double alpha) {
    constexpr int steps = 48;
    Scattered sum;
    for (int i = 0; i < steps; ++i) {
        const Scattered s = integrate(std::sqrt((i + 0.5) / steps), alpha, index);
        sum.all += s.all;
        sum.transmitted += s.transmitted;
    }
    return sum.transmitted / sum.all;
}

int thousandths(double share) {
    return static_cast<int>(std::lround(1000 * std::clamp(share, 0., 1.)));
}

void print_losses() {
    const auto equal = [](int) { return 1.; };
    constexpr int of_place = 2 * 2 * kCosines;
    std::vector<double> lost =
        fit(losses(), {places(kIndices) * places(kRoughnesses) * 4, kCosines, 1}, equal);
    lost = fit(lost, {places(kIndices), kRoughnesses, of_place}, equal);
    lost = fit(lost, {1, kIndices, kRoughnesses * of_place}, weight_of_index);
    std::printf(
        "/// Light lost, in thousandths: [index][roughness][specular 1, 0][side: lower index, "
        "higher]\n"
        "/// [cosine].\n"
        "inline constexpr uint16_t kGlassLoss[%d][%d][2][2][%d] = {\n",
        kIndices, kRoughnesses, kCosines);
    for (int i = 0; i < kIndices * kRoughnesses; ++i) {
        std::printf(i % kRoughnesses == 0 ? "{{{" : "{{");
        for (int j = 0; j < of_place; ++j) {
            std::printf(j % kCosines == 0 ? "{%d" : ",%d",
                        thousandths(lost[i * of_place + j] - kLower));
            if (j % kCosines != kCosines - 1) continue;
            const int row = j / kCosines;
            std::printf("%s", row == 0 || row == 2 ? "}," : row == 1 ? "}},{\n" : "}}}");
        }
        std::printf(i % kRoughnesses == kRoughnesses - 1 ? "},\n" : ",\n");
    }
    std::printf("};\n");
}

void print_crossings() {
    std::printf(
        "/// Mean transmittance of single scattering from the side of the lower index, at specular "
        "1, "
        "in\n/// thousandths.\n"
        "inline constexpr uint16_t kGlassCrossing[%d][%d] = {\n",
        kIndices, kRoughnesses);
    for (int i = 0; i < kIndices; ++i)
        for (int r = 0; r < kRoughnesses; ++r)
            std::printf("%s%d%s", r == 0 ? "{" : ",",
                        thousandths(crossing(index_at(place(i * kFiner, kIndices)),
                                             alpha_at(place(r * kFiner, kRoughnesses)))),
                        r == kRoughnesses - 1 ? "},\n" : "");
    std::printf("};\n");
}

}  // namespace

int main() {
    std::printf(
        "// SPDX-License-Identifier: Apache-2.0\n"
        "// Made by tests/make/make_glass_loss.cpp; do not edit.\n#pragma once\n\n"
        "#include <cstdint>\n\nnamespace petzval {\n\n"
        "inline constexpr int kGlassLossIndices = %d, kGlassLossRoughnesses = %d,\n"
        "                     kGlassLossCosines = %d;\n"
        "/// Index n of the last: n = (1 + f^2) / (1 - f^2), of which f is spread evenly from 0.\n"
        "inline constexpr float kGlassLossMostF = %gf;\n"
        "/// sqrt(alpha) of the first, spread evenly up to 1.\n"
        "inline constexpr float kGlassLossLeastRoughness = %.9gf;\n"
        "/// Cosines c = k x^2 / (1 + k - x^2), x spread evenly from 0 to 1, with k so many "
        "alpha.\n"
        "inline constexpr float kGlassLossKnee = %.1ff;\n"
        "// clang-format off\n",
        kIndices, kRoughnesses, kCosines, kMostF, kLeastRoughness, kKnee);
    print_losses();
    print_crossings();
    std::printf("// clang-format on\n\n}  // namespace petzval\n");
}
