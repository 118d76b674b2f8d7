// SPDX-License-Identifier: Apache-2.0
#include "core/light/spherical_triangle.h"

#include <numbers>

#include "tests/support/chi_square.h"

namespace petzval {
namespace {

using test::Random;
using Corners = std::array<V3f, 3>;

// The spherical excess from the three angles (Girard 1629), in long double.
long double girard(const V3f& p, const Corners& corner) {
    using V = Imath::Vec3<long double>;
    std::array<V, 3> to;
    for (size_t i = 0; i < 3; ++i) to[i] = (V(V3d(corner[i])) - V(V3d(p))).normalized();
    long double sum = -std::numbers::pi_v<long double>;
    for (size_t i = 0; i < 3; ++i) {
        const V &a = to[i], &b = to[(i + 1) % 3], &c = to[(i + 2) % 3];
        const V u = (b - a * a.dot(b)).normalized(), v = (c - a * a.dot(c)).normalized();
        sum += 2 * std::asin(std::min(1.L, (u - v).length() / 2));
    }
    return sum;
}

Corners any_triangle(Random& random) {
    const float size = std::pow(10.f, 3 * random.next() - 1.5f);
    const V3f about = random.direction();
    return {about + random.direction() * size, about + random.direction() * size,
            about + random.direction() * size};
}

TEST(SphericalTriangle, SolidAngleIsGirards) {
    Random random(1);
    const V3f p(0.1f, -0.2f, 0.05f);
    for (int i = 0; i < 20000; ++i) {
        const Corners corner = any_triangle(random);
        const auto expected = static_cast<double>(girard(p, corner));
        ASSERT_NEAR(SphericalTriangle(p, corner).solid_angle(), expected, 2e-6 + 1e-6 * expected);
    }
}

TEST(SphericalTriangle, AnOctantAndAHalfSphere) {
    const V3f o(0.f);
    EXPECT_FLOAT_EQ(SphericalTriangle(o, {V3f(2, 0, 0), V3f(0, 1, 0), V3f(0, 0, 5)}).solid_angle(),
                    kPi / 2);
    EXPECT_NEAR(SphericalTriangle(
                    o, {V3f(1e4f, 0, 1e-3f), V3f(-5e3f, 8e3f, 1e-3f), V3f(-5e3f, -8e3f, 1e-3f)})
                    .solid_angle(),
                2 * kPi, 1e-5);
}

double solid_angle(const V3f& a, const V3f& b, const V3f& c) {
    return double(SphericalTriangle(V3f(0.f), {a, b, c}).solid_angle());
}

// Uniform in two steps: strips from the second corner have equal areas, and within a thin strip the
// height of the cap about that corner is (Archimedes).
TEST(SphericalTriangle, DirectionsAreUniform) {
    const V3f o(0.f);
    const std::vector<Corners> triangles{
        {V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)},
        {V3f(-0.5f, 1, -0.4f), V3f(1.1f, 1.2f, 0.1f), V3f(0.2f, 0.7f, 1.3f)},
        {V3f(-3, 0.1f, -2), V3f(3, 0.1f, -2), V3f(0, 0.1f, 4)},
        {V3f(-3, 0.01f, -2), V3f(3, 0.01f, -2), V3f(0, 0.01f, 4)},
        {V3f(1, 0.02f, 1), V3f(1, -0.02f, 1), V3f(1, 0, 1.5f)},
        {V3f(5, 0.001f, 0.3f), V3f(-4, 0.002f, 0.2f), V3f(1, 0.3f, 0.2f)}};
    constexpr int kSide = 64;
    for (size_t k = 0; k < triangles.size(); ++k) {
        const SphericalTriangle seen(o, triangles[k]);
        const auto at = [&](int i, int j) {
            return seen.direction(V2f(float(i) / kSide, float(j) / kSide));
        };
        const double share = double(seen.solid_angle()) / (kSide * kSide);
        const V3d pole = V3d(at(0, 0));
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                const double whole = 1 - pole.dot(V3d(at(i, kSide)));
                ASSERT_NEAR((1 - pole.dot(V3d(at(i, j)))) / whole, double(j) / kSide, 1e-3)
                    << k << " " << i << " " << j;
            }
        for (int i = 0; i < kSide; ++i) {
            const double strip = solid_angle(at(0, 0), at(i, kSide), at(i + 1, kSide));
            ASSERT_NEAR(strip, kSide * share, 1e-3 * kSide * share) << k << " " << i;
        }
    }
}

// The area below a draw is u.x of the whole, also where it passes pi.
TEST(SphericalTriangle, TheDrawnAreaGrowsSteadily) {
    const SphericalTriangle seen(V3f(0.f),
                                 {V3f(-3, 0.01f, -2), V3f(3, 0.01f, -2), V3f(0, 0.01f, 4)});
    const double whole = double(seen.solid_angle());
    ASSERT_GT(whole, 6);
    for (int i = -200; i <= 200; ++i) {
        const float u = kPi / seen.solid_angle() + float(i) * 5e-6f;
        const double below =
            solid_angle(seen.direction(V2f(0, 0)), seen.direction(V2f(0, kOneMinus)),
                        seen.direction(V2f(u, kOneMinus)));
        ASSERT_NEAR(below / whole, double(u), 1e-5) << i;
    }
}

TEST(SphericalTriangle, DirectionsPointIntoIt) {
    Random random(2);
    const V3f p(0.f);
    int used = 0;
    for (int i = 0; i < 20000; ++i) {
        const Corners corner = any_triangle(random);
        const SphericalTriangle seen(p, corner);
        if (!(seen.solid_angle() > 1e-4f)) continue;
        ++used;
        const V3d normal = V3d(corner[0]).cross(V3d(corner[1]));
        const double side = normal.dot(V3d(corner[2])) > 0 ? 1 : -1;
        for (int n = 0; n < 8; ++n) {
            const V3f w = seen.direction(random.next2());
            ASSERT_NEAR(w.length(), 1, 1e-6);
            for (size_t e = 0; e < 3; ++e) {
                const V3d edge = V3d(corner[e]).cross(V3d(corner[(e + 1) % 3])).normalized();
                ASSERT_GT(side * edge.dot(V3d(w)), -1e-4) << i;
            }
        }
    }
    EXPECT_GT(used, 15000);
}

}  // namespace
}  // namespace petzval
