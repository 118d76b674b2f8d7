// SPDX-License-Identifier: Apache-2.0
// Prints core/shading/ggx_albedo_table.h: the directional albedo of single-scattering GGX, by
// quadrature over the visible normals. Run it as: make_ggx_albedo > core/shading/ggx_albedo_table.h
#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

constexpr int kSize = 32;
constexpr int kSteps = 512;

struct Albedo {
    double total = 0, schlick = 0;
};

double lambda(double tan2, double alpha) {
    return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

// Midpoint rule in the unit square that the spherical-cap method maps onto the visible normals;
// each normal then weighs G2 / G1.
Albedo integrate(double mu, double alpha) {
    Albedo sum;
    const double sin_o = std::sqrt(1 - mu * mu);
    const double length = std::hypot(alpha * sin_o, mu);
    const double sx = alpha * sin_o / length, sz = mu / length;
    const double lambda_o = lambda((1 - mu * mu) / (mu * mu), alpha);
    for (int i = 0; i < kSteps; ++i) {
        const double z = 1 - (i + 0.5) / kSteps * (1 + sz);
        const double sin_theta = std::sqrt(std::fmax(0, 1 - z * z));
        for (int j = 0; j < kSteps; ++j) {
            const double phi =
                std::numbers::pi * (j + 0.5) / kSteps;  // the other half mirrors this one
            double mx = (sin_theta * std::cos(phi) + sx) * alpha;
            double my = sin_theta * std::sin(phi) * alpha;
            double mz = std::fmax(z + sz, 1e-300);
            const double norm = std::sqrt(mx * mx + my * my + mz * mz);
            mx /= norm, my /= norm, mz /= norm;
            const double cosine = sin_o * mx + mu * mz;
            const double wi_z = 2 * cosine * mz - mu;
            if (wi_z <= 0 || cosine <= 0) continue;
            const double lambda_i = lambda((1 - wi_z * wi_z) / (wi_z * wi_z), alpha);
            const double weight = (1 + lambda_o) / (1 + lambda_o + lambda_i);
            sum.total += weight;
            sum.schlick += weight * std::pow(1 - cosine, 5);
        }
    }
    const double n = double(kSteps) * kSteps;
    return {sum.total / n, sum.schlick / n};
}

}  // namespace

int main() {
    std::printf(
        "// SPDX-License-Identifier: Apache-2.0\n"
        "// Made by tests/make/make_ggx_albedo.cpp; do not edit.\n#pragma once\n\n"
        "namespace petzval {\n\n"
        "inline constexpr int kGgxAlbedoSize = %d;\n"
        "/// [sqrt(alpha)][sqrt(cosine)], ends included: {single-scatter albedo, its part "
        "weighted by (1 - cos)^5}.\n"
        "// clang-format off\n"
        "inline constexpr float kGgxAlbedo[%d][%d][2] = {\n",
        kSize, kSize, kSize);
    for (int a = 0; a < kSize; ++a) {
        std::printf("{");
        for (int c = 0; c < kSize; ++c) {
            const double root_mu = std::fmax(c / (kSize - 1.0), 1e-3);
            const double root_alpha = std::fmax(a / (kSize - 1.0), 1e-2);
            const Albedo e = integrate(root_mu * root_mu, root_alpha * root_alpha);
            std::printf("{%.6ff,%.6ff}%s", e.total, e.schlick, c + 1 < kSize ? "," : "},\n");
            if (c % 6 == 5) std::printf("\n");
        }
    }
    std::printf("};\n// clang-format on\n\n}  // namespace petzval\n");
}
