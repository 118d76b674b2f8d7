// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/warp.h"

#include <numbers>

#include "tests/support/chi_square.h"
#include "tests/support/jacobian.h"

namespace petzval {
namespace {

using test::Random;

V3f flat(V2f p) {
    return {p.x, p.y, 0.f};
}

TEST(Trig, SincosOfTurns) {
    for (int i = -3000; i <= 3000; ++i) {
        const float turns = static_cast<float>(i) / 1000;
        const SinCos got = sincos_turns(turns);
        const double angle = 2 * std::numbers::pi * turns;
        ASSERT_NEAR(got.sine, std::sin(angle), 2e-7 * std::max(1.0, std::fabs(angle))) << turns;
        ASSERT_NEAR(got.cosine, std::cos(angle), 2e-7 * std::max(1.0, std::fabs(angle))) << turns;
    }
}

TEST(Trig, Atan2OfTurns) {
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
        const float y = 2 * random.next() - 1, x = 2 * random.next() - 1;
        ASSERT_NEAR(atan2_turns(y, x), std::atan2(double{y}, double{x}) / (2 * std::numbers::pi),
                    1e-7);
    }
    EXPECT_EQ(atan2_turns(0.f, 0.f), 0.f);
    EXPECT_EQ(atan2_turns(0.f, 1.f), 0.f);
    EXPECT_EQ(atan2_turns(1.f, 0.f), 0.25f);
    EXPECT_EQ(atan2_turns(-1.f, 0.f), -0.25f);
    EXPECT_EQ(atan2_turns(0.f, -1.f), 0.5f);
    EXPECT_EQ(atan2_turns(-0.f, -1.f), -0.5f);
}

// Whatever the share and where it lies, even one that few of a sampler's numbers fall into.
TEST(Warp, WhatAChoiceLeavesIsUniform) {
    for (const float share : {1.f, 0.7f, 0.01f, 1e-4f, 1e-5f, 3e-7f}) {
        Random random(5);
        constexpr int kDraws = 100000, kCells = 64;
        std::array<double, kCells> found{};
        for (int i = 0; i < kDraws; ++i) {
            // A number of 24 bits that lies in the share, which begins anywhere.
            const double units = double(share) * 0x1p24, first = random.next() * 0x1p24 - units;
            const double count = std::max(1., std::floor(first + units) - std::floor(first));
            const double unit = std::floor(first) + 1 + std::floor(random.next() * count);
            const auto left = static_cast<float>(std::clamp((unit - first) / units, 0., 1.));
            const float u = left_of_unit(std::min(left, kOneMinus), share, random.next());
            ASSERT_TRUE(u >= 0 && u < 1);
            found[size_t(u * kCells)] += 1;
        }
        double squares = 0;
        for (const double n : found) squares += sqr(n - double(kDraws) / kCells);
        EXPECT_GE(test::chi_square_p(squares * kCells / kDraws, kCells - 1), test::sidak())
            << share;
    }
}

TEST(Warp, DiskIsUniform) {
    const auto density = [](double x, double y) {
        return x * x + y * y < 1 ? uniform_disk_pdf() : 0.f;
    };
    // In polar coordinates, so that no cell is cut by the rim.
    const auto polar = [&](double radius, double turn) {
        return radius *
               density(radius * std::cos(2 * std::numbers::pi * turn),
                       radius * std::sin(2 * std::numbers::pi * turn)) *
               2 * std::numbers::pi;
    };
    const auto place = [](Random& random) -> std::optional<V2f> {
        const V2f p = uniform_disk(random.next2());
        const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
        return V2f(p.length(), static_cast<float>(turn < 0 ? turn + 1 : turn));
    };
    EXPECT_TRUE(test::chi_square_grid({0, 1, 0, 1, 20, 40}, polar, place, 200000, 2));
    EXPECT_TRUE(test::jacobian_matches([](V2f u) { return flat(uniform_disk(u)); },
                                       [](V3f) { return uniform_disk_pdf(); }, 3));
}

TEST(Warp, DiskKeepsItsCentreAndRim) {
    EXPECT_EQ(uniform_disk({0.5f, 0.5f}), V2f(0, 0));
    EXPECT_NEAR(uniform_disk({0, 0}).length(), 1, 1e-6);
    EXPECT_NEAR(uniform_disk({1, 0.5f}).x, 1, 1e-6);
    EXPECT_NEAR(uniform_disk({0.5f, 1}).y, 1, 1e-6);
    EXPECT_NEAR(uniform_disk({0, 0.5f}).x, -1, 1e-6);
}

TEST(Warp, CosineHemisphere) {
    const auto pdf = [](const V3f& w) { return cosine_hemisphere_pdf(w.z); };
    EXPECT_TRUE(test::chi_square_sphere(
        [](Random& random) { return cosine_hemisphere(random.next2()); }, pdf, 4));
    EXPECT_TRUE(test::jacobian_matches(cosine_hemisphere, pdf, 5));
}

TEST(Warp, UniformSphere) {
    const auto pdf = [](const V3f&) { return uniform_sphere_pdf(); };
    EXPECT_TRUE(test::chi_square_sphere(
        [](Random& random) { return uniform_sphere(random.next2()); }, pdf, 6));
    EXPECT_TRUE(test::jacobian_matches(uniform_sphere, pdf, 7));
}

TEST(Warp, DirectionsAreUnit) {
    Random random(8);
    for (int i = 0; i < 10000; ++i) {
        const V2f u = random.next2();
        ASSERT_NEAR(uniform_sphere(u).length(), 1, 1e-6);
        ASSERT_NEAR(cosine_hemisphere(u).length(), 1, 1e-6);
    }
}

TEST(Warp, TriangleIsUniform) {
    // 16 equal parts: a point's part follows from its three weights times 4.
    std::vector<double> observed(64), expected(64);
    Random random(9);
    for (int i = 0; i < 100000; ++i) {
        const V2f b = uniform_triangle(random.next2());
        ASSERT_GE(b.x, 0);
        ASSERT_GE(b.y, 0);
        ASSERT_LE(b.x + b.y, 1 + 1e-6f);
        const int x = std::min(static_cast<int>(4 * b.x), 3),
                  y = std::min(static_cast<int>(4 * b.y), 3);
        const bool upper = 4 * b.x - x + 4 * b.y - y > 1;
        ++observed[(4 * y + x) * 2 + upper];
    }
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x + y < 4; ++x)
            for (int upper = 0; upper < (x + y < 3 ? 2 : 1); ++upper)
                expected[(4 * y + x) * 2 + upper] = 100000.0 / 16;
    EXPECT_TRUE(test::chi_square({observed.begin(), observed.begin() + 32},
                                 {expected.begin(), expected.begin() + 32}));
    EXPECT_TRUE(test::jacobian_matches([](V2f u) { return flat(uniform_triangle(u)); },
                                       [](V3f) { return uniform_triangle_pdf(); }, 10));
}

}  // namespace
}  // namespace petzval
