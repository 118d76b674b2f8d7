// SPDX-License-Identifier: Apache-2.0
// Prints core/shading/sheen_albedo_table.h: the directional albedo of the sheen lobe, by quadrature
// over the hemisphere, in doubles and apart from core/shading/sheen.cpp. Run it as:
// make_sheen_albedo > core/shading/sheen_albedo_table.h
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

constexpr int kSize = 32;
constexpr double kSmallestRoughness = 0.07;  // as in sheen.h
constexpr int kSteps = 1024;

// Estevez and Kulla 2017, equations 3 and 4.
double lambda(double cosine, double alpha) {
    const double t = (1 - alpha) * (1 - alpha);
    const auto mix = [t](double wide, double narrow) { return wide + (narrow - wide) * t; };
    const double a = mix(21.5473, 25.3245), b = mix(3.82987, 3.32435), c = mix(0.19823, 0.16801),
                 d = mix(-1.97760, -1.27393), e = mix(-4.32054, -4.85967);
    const auto curve = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
    return std::exp(cosine < 0.5 ? curve(cosine) : 2 * curve(0.5) - curve(1 - cosine));
}

// Midpoint rule, finer towards grazing directions, where the lobe is.
double albedo(double roughness, double mu) {
    const double alpha = roughness * roughness, sin_o = std::sqrt(1 - mu * mu);
    const double lambda_o = lambda(mu, alpha);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double root = (i + 0.5) / kSteps, z = root * root;
        const double sin_i = std::sqrt(1 - z * z), lambda_i = lambda(z, alpha);
        double ring = 0;
        for (int j = 0; j < kSteps; ++j) {
            const double phi = std::numbers::pi * (j + 0.5) / kSteps;
            const double x = sin_i * std::cos(phi) + sin_o, y = sin_i * std::sin(phi), h = z + mu;
            const double cos2 = h * h / (x * x + y * y + h * h);
            ring += std::pow(std::max(0., 1 - cos2), 0.5 / alpha);
        }
        sum += ring / kSteps * 2 * root / ((1 + lambda_o + lambda_i) * 4 * mu);
    }
    return (2 + 1 / alpha) * sum / kSteps;
}

}  // namespace

int main() {
    std::printf(
        "// SPDX-License-Identifier: Apache-2.0\n"
        "// Made by tests/make/make_sheen_albedo.cpp; do not edit.\n#pragma once\n\n"
        "namespace petzval {\n\n"
        "inline constexpr int kSheenAlbedoSize = %d;\n"
        "/// [sqrt of the way of the roughness from %g to 1][sqrt(cosine)], ends included.\n"
        "// clang-format off\n"
        "inline constexpr float kSheenAlbedo[%d][%d] = {\n",
        kSize, kSmallestRoughness, kSize, kSize);
    for (int r = 0; r < kSize; ++r) {
        const double row = r / (kSize - 1.0);  // finer where the lobe is narrow
        const double roughness = kSmallestRoughness + (1 - kSmallestRoughness) * row * row;
        std::printf("{");
        for (int c = 0; c < kSize; ++c) {
            const double root_mu = std::fmax(c / (kSize - 1.0), 0.02);
            std::printf("%.5ff%s", albedo(roughness, root_mu * root_mu),
                        c + 1 < kSize ? "," : "},\n");
            if (c % 12 == 11) std::printf("\n");
        }
    }
    std::printf("};\n// clang-format on\n\n}  // namespace petzval\n");
}
