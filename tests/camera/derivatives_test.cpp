// SPDX-License-Identifier: Apache-2.0
// Derivatives of rays through a lens.
#include <gtest/gtest.h>

#include <cmath>

#include "camera/lens/paraxial.h"
#include "camera/lens/trace.h"
#include "tests/support/lens_json.h"
#include "tests/support/lens_rays.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using test::kLensKinds;
using test::lens_of;
using test::ray_of;
using test::surface_of;
using test::usual_ray;
using test::whole;

using D = Dual<d4>;

/// The ray that is moved by u mm and turned by v rad about an axis that is neither x nor y.
LensRay<D> moved(const LensRay<d4>& start, D u, D v) {
    LensRay<D> ray;
    ray.counted_from = start.counted_from;
    const D one = constant<D>(broadcast<d4>(1));
    const Vec3<D> turned{start.direction.x + 0.7 * v, start.direction.y - 0.4 * v,
                         one * start.direction.z};
    ray.direction = turned * (1.0 / sqrt(dot(turned, turned)));
    ray.origin = {start.origin.x + 0.6 * u, start.origin.y + 0.8 * u, one * start.origin.z};
    return ray;
}

TEST(Dual, JacobiansAreThoseOfCentralDifferences) {
    test::Random random(9);
    constexpr double kStep = 1e-5;
    for (const char* name : kLensKinds) {
        const Lens lens(test::read_lens(name));
        const auto indices = lens.exact_indices(d4{486.1327, 540, 587.5618, 656.2725});
        const auto end = [&](const LensRay<d4>& start, double u, double v, bool derive) {
            const d4 unit = broadcast<d4>(derive);
            auto ray = moved(start, D{broadcast<d4>(u), unit, {}}, D{broadcast<d4>(v), {}, unit});
            EXPECT_TRUE(
                all(trace_lens({lens, Towards::Film, whole(lens), Clip::No}, indices, ray)));
            return ray;
        };
        for (int i = 0; i < 20; ++i) {
            const auto start = usual_ray(lens, random);
            const auto exact = end(start, 0, 0, true);
            const auto right = end(start, kStep, 0, false), left = end(start, -kStep, 0, false);
            const auto up = end(start, 0, kStep, false), down = end(start, 0, -kStep, false);
            const auto compare = [&](auto number) {
                const D value = number(exact);
                const d4 du = (number(right).value - number(left).value) / (2 * kStep);
                const d4 dv = (number(up).value - number(down).value) / (2 * kStep);
                for (int k = 0; k < 4; ++k) {
                    EXPECT_NEAR(value.du[k], du[k], 1e-7 * (1 + std::fabs(du[k]))) << name;
                    EXPECT_NEAR(value.dv[k], dv[k], 1e-7 * (10 + std::fabs(dv[k]))) << name;
                }
            };
            compare([](const auto& ray) { return ray.origin.x; });
            compare([](const auto& ray) { return ray.origin.y; });
            compare([](const auto& ray) { return ray.origin.z; });
            compare([](const auto& ray) { return ray.direction.x; });
            compare([](const auto& ray) { return ray.direction.y; });
            compare([](const auto& ray) { return ray.direction.z; });
        }
    }
}

TEST(Dual, DerivativesAreFiniteAtThePoleOfAnOddAsphere) {
    auto surface = surface_of(0, 5, 1.6);
    surface.asphere = {{3, 1e-3}};
    const Lens lens = lens_of({surface});
    auto ray = moved(ray_of<d4>({0, 0, -1}, {0, 0, 1}), D{d4{}, broadcast<d4>(1), {}},
                     D{d4{}, {}, broadcast<d4>(1)});
    ASSERT_TRUE(all(trace_lens({lens, Towards::Film, whole(lens), Clip::No},
                               lens.exact_indices(broadcast<d4>(kLineD_nm)), ray)));
    EXPECT_NEAR(ray.origin.x.du[0], 0.6, 1e-15);
    EXPECT_NEAR(ray.origin.x.dv[0], 0.7, 1e-15);
    EXPECT_NEAR(ray.direction.x.dv[0], 0.7 / 1.6, 1e-15);
    EXPECT_EQ(sqrt(D{d4{}, broadcast<d4>(1), {}}).du[0], 0);
}

// Etendue: dx dy dp dq is the same before and behind a lens. In a plane of symmetry this holds for
// the two coordinates alone.
TEST(Dual, JacobiansKeepEtendue) {
    const Lens lens(test::read_lens("canon-14mm-f2.8-asph"));
    const auto indices = lens.exact_indices(f4{486.1327f, 540, 587.5618f, 656.2725f});
    using F = Dual<f4>;
    const F one = constant<F>(splat(1));
    for (const float sine : {0.f, 0.2f, 0.5f}) {
        // u: height where the ray meets z = 0; v: sine of its angle.
        LensRay<F> ray;
        const F q{splat(sine), {}, splat(1)};
        ray.direction = {F{}, q, sqrt(one - q * q)};
        const float entrance = float(first_order(lens, kLineD_nm).entrance_pupil_mm);
        ray.origin = {F{}, F{splat(-entrance * sine), splat(1), {}}, F{}};
        ASSERT_TRUE(all(trace_lens({lens, Towards::Film, whole(lens), Clip::No}, indices, ray)));
        // Back to the plane of the last vertex.
        const F y = ray.origin.y - ray.origin.z * ray.direction.y / ray.direction.z;
        const F p = ray.direction.y;
        for (int i = 0; i < 4; ++i)
            EXPECT_NEAR(y.du[i] * p.dv[i] - y.dv[i] * p.du[i], 1, 1e-4) << sine;
    }
}

}  // namespace
}  // namespace petzval::camera
