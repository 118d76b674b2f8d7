// SPDX-License-Identifier: Apache-2.0
#include "core/scene/cube_sky.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "core/scene/sky.h"

namespace petzval {
namespace {

V3f direction_of(uint32_t i) {
    const auto unit_float = [](uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
    return uniform_sphere(V2f(unit_float(sobol_0(i)), unit_float(sobol_1(i))));
}

// Smooth, and different in all directions.
Rgb smooth(const V3f& d) {
    return {2 + d.x + 0.3f * d.y * d.z, 2 + d.y - 0.5f * d.x * d.z, 2 + d.z};
}

/// What an eye in the middle sees towards each face: right is the way it looks times up.
CubeFaces seen_by_an_eye(int size) {
    constexpr std::array<std::array<float, 6>, 6> ways = {{{1, 0, 0, 0, 1, 0},
                                                           {-1, 0, 0, 0, 1, 0},
                                                           {0, 1, 0, 0, 0, -1},
                                                           {0, -1, 0, 0, 0, 1},
                                                           {0, 0, 1, 0, 1, 0},
                                                           {0, 0, -1, 0, 1, 0}}};
    CubeFaces cube{size, {}};
    for (size_t f = 0; f < 6; ++f) {
        const V3f forward(ways[f][0], ways[f][1], ways[f][2]),
            up(ways[f][3], ways[f][4], ways[f][5]);
        const V3f right = forward.cross(up);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const float s = (2 * static_cast<float>(x) + 1) / static_cast<float>(size) - 1;
                const float t = (2 * static_cast<float>(y) + 1) / static_cast<float>(size) - 1;
                const Rgb value = smooth(unit(forward + right * s - up * t));
                for (int c = 0; c < 3; ++c) cube.texel[f].push_back(value[c]);
            }
    }
    return cube;
}

TEST(CubeSky, FacesAreWhatAnEyeInTheMiddleSees) {
    const CubeFaces cube = seen_by_an_eye(64);
    for (uint32_t i = 0; i < 4096; ++i) {
        const V3f d = direction_of(i);
        const Rgb found = cube.radiance(d), expected = smooth(d);
        // Half a texel at a face's rim is not bilinear.
        std::array<float, 3> sides{std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
        std::sort(sides.begin(), sides.end());
        const float tolerance = sides[1] < 0.98f * sides[2] ? 0.002f : 0.03f;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << d;
    }
    EXPECT_EQ(seen_by_an_eye(1).radiance(unit(V3f(1, 0.2f, -0.3f)))[0], 3);
}

// A sky that is made of one tells the same.
TEST(CubeSky, BecomesASky) {
    const CubeFaces cube = seen_by_an_eye(64);
    const Sky sky = Sky::picture(sky_texels(128, [&](const V3f& d) { return cube.radiance(d); }),
                                 256, 128, 0, 1);
    for (uint32_t i = 0; i < 4096; ++i) {
        const V3f d = direction_of(i);
        const Rgb found = sky.radiance(d), expected = smooth(d);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.04) << d;
    }
}

// One face of six has a sixth of the sphere, and twice its part of a surface that faces it: the
// configuration factor of half a cube's top is 0.5541 (Howell, C-11).
TEST(CubeSky, OneFaceShines) {
    CubeFaces cube{32, {}};
    for (auto& face : cube.texel) face.assign(3 * 32 * 32, 0.f);
    cube.texel[2].assign(3 * 32 * 32, 1.f);
    double mean = 0, factor = 0;
    constexpr uint32_t count = 1 << 16;
    for (uint32_t i = 0; i < count; ++i) {
        const V3f d = direction_of(i);
        const auto found = double(cube.radiance(d)[0]);
        mean += found / count;
        factor += found * std::max(double(d.y), 0.) * 4 / count;
    }
    EXPECT_NEAR(mean, 1 / 6., 1e-3);
    EXPECT_NEAR(factor, 0.5541, 2e-3);
}

// L = a + b.d has E = pi a + (2 pi / 3) b.n, and (y^2 - z^2) comes back a quarter of pi as strong.
TEST(CubeSky, HarmonicsOfTheIrradianceGiveTheRadiance) {
    const auto radiance = [](const V3f& d) {
        return 2 + 0.5 * double(d.x) - 0.25 * double(d.y) + 0.125 * double(d.z) +
               0.3 * double(d.x * d.z) + 0.1 * double(d.y * d.y - d.z * d.z);
    };
    const auto irradiance = [](const V3f& n) {
        const double pi = double(kPi);
        return pi * 2 +
               2 * pi / 3 * (0.5 * double(n.x) - 0.25 * double(n.y) + 0.125 * double(n.z)) +
               pi / 4 * (0.3 * double(n.x * n.z) + 0.1 * double(n.y * n.y - n.z * n.z));
    };
    // Coefficients by projection on the basis in polynomials: sqrt(1 / 4 pi), sqrt(3 / 4 pi) y ...
    const auto basis = [](int i, const V3f& d) {
        const double x = double(d.x), y = double(d.y), z = double(d.z), pi = double(kPi);
        const double k = std::sqrt(15 / (4 * pi));
        switch (i) {
            case 0:
                return std::sqrt(1 / (4 * pi));
            case 1:
                return std::sqrt(3 / (4 * pi)) * y;
            case 2:
                return std::sqrt(3 / (4 * pi)) * z;
            case 3:
                return std::sqrt(3 / (4 * pi)) * x;
            case 4:
                return k * x * y;
            case 5:
                return k * y * z;
            case 6:
                return std::sqrt(5 / (16 * pi)) * (3 * z * z - 1);
            case 7:
                return k * x * z;
            default:
                return k / 2 * (x * x - y * y);
        }
    };
    Harmonics harmonics;
    constexpr uint32_t count = 1 << 16;
    for (int i = 0; i < 9; ++i) {
        double sum = 0;
        for (uint32_t k = 0; k < count; ++k) {
            const V3f d = direction_of(k);
            sum += irradiance(d) * basis(i, d) * 4 * double(kPi) / count;
        }
        harmonics[size_t(i)] = Rgb(static_cast<float>(sum));
    }
    for (uint32_t i = 0; i < 256; ++i) {
        const V3f d = direction_of(i);
        EXPECT_NEAR(radiance_of_irradiance(harmonics, d)[1], radiance(d), 2e-3) << d;
    }
    harmonics[0] = Rgb(0.f);
    for (uint32_t i = 0; i < 256; ++i)
        EXPECT_GE(radiance_of_irradiance(harmonics, direction_of(i))[0], 0);
}

}  // namespace
}  // namespace petzval
