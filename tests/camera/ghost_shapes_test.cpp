// SPDX-License-Identifier: Apache-2.0
// Where ghosts lie and what shape they have, against matrices of paraxial optics.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/measure/ghost_light.h"

namespace petzval::camera {
namespace {

/// Height and angle, in the medium, of a ray near the axis.
struct Paraxial {
    double y = 0, u = 0;
};

/// Heights of a ghost's ray at the stop, the last time that it comes there, and at the film.
struct ParaxialEnd {
    double stop = 0, film = 0;
};

// Refraction n' u' = n u - y (n' - n) c, reflection with n' = -n.
ParaxialEnd paraxial_ghost(const Lens& lens, double film_mm, GhostPair pair, Paraxial ray) {
    const LensIndices<d4> n = lens.exact_indices(broadcast<d4>(kLineD_nm));
    double index = 1, z_mm = lens.vertex_mm(0);
    ParaxialEnd out;
    const auto go = [&](double to_mm) {
        ray.y += ray.u * (to_mm - z_mm);
        z_mm = to_mm;
    };
    const auto meet = [&](int surface, bool mirrors) {
        go(lens.vertex_mm(surface));
        if (surface == lens.stop()) out.stop = ray.y;
        const auto& s = lens.surfaces<double>()[size_t(surface)];
        const double behind = n.of_medium[index > 0 ? s.medium_after : s.medium_before][0];
        const double into = mirrors ? -index : std::copysign(behind, index);
        const double c = lens.prescription().surfaces[size_t(surface)].curvature_1_mm;
        ray.u = (index * ray.u - ray.y * (into - index) * c) / into;
        index = into;
    };
    for (int i = 0; i < pair.first; ++i) meet(i, false);
    meet(pair.first, true);
    for (int i = pair.first - 1; i > pair.second; --i) meet(i, false);
    meet(pair.second, true);
    for (int i = pair.second + 1; i < lens.size(); ++i) meet(i, false);
    go(film_mm);
    out.film = ray.y;
    return out;
}

TEST(GhostShapes, OfASmallAngleLieWhereParaxialOpticsSays) {
    const auto camera = test::ghostly("double-gauss-100mm-f2", Coating::Uncoated);
    const GhostOptics optics(camera);
    const Lens& lens = optics.lens();
    const LensIndices<d4> n = lens.exact_indices(broadcast<d4>(kLineD_nm));
    const double angle = 1e-4;
    int tested = 0;
    for (const GhostPair pair : optics.pairs()) {
        LensRay<d4> traced;
        traced.direction = {d4{}, broadcast<d4>(std::sin(angle)), broadcast<d4>(std::cos(angle))};
        if (!trace_ghost<d4>(lens, pair, Towards::Film, Clip::No, n, traced,
                             [](const auto&, const GhostStep&) {})[0])
            continue;
        const double to_film =
            camera->input().film_mm - lens.vertex_mm(traced.counted_from) - traced.origin.z[0];
        const double y =
            traced.origin.y[0] + to_film * traced.direction.y[0] / traced.direction.z[0];
        const double expected =
            paraxial_ghost(lens, camera->input().film_mm, pair, {0, angle}).film;
        EXPECT_NEAR(y, expected, 1e-3 * std::fabs(expected) + 1e-7)
            << pair.first << "," << pair.second;
        ++tested;
    }
    EXPECT_GT(tested, 20);
}

/// The double Gauss, whose iris is a small star, and of whose surfaces two alone reflect.
std::shared_ptr<const LensCamera> starry(GhostPair pair) {
    LensCameraInput in = test::input_of(test::kGauss, DispersionMode::Shared);
    Prescription file = in.lens->prescription();
    for (int i = 0; i < in.lens->size(); ++i)
        if (i != pair.first && i != pair.second) file.surfaces[size_t(i)].coat = Coating::Ideal;
    in.lens = std::make_shared<const Lens>(file);
    in.to_world = M44f();
    in.iris = Iris(star(5), 1.2);
    in.coating = Coating::Filed;
    return std::make_shared<LensCamera>(std::move(in));
}

/// Whether the iris is everywhere the same within a distance of a point.
bool is_even(const Iris& iris, V2f at, float within_mm) {
    for (int i = 0; i < 32; ++i)
        for (const float share : {0.2f, 0.4f, 0.6f, 0.8f, 1.f}) {
            const float a = float(i) * kPi / 16;
            if (iris.transmits(at + V2f(std::cos(a), std::sin(a)) * (within_mm * share)) !=
                iris.transmits(at))
                return false;
        }
    return true;
}

// The sun's light is parallel, so that the ghost is the iris, as large as a matrix says. Of the
// iris's reach 6 % are left to what the lens has of aberrations, and to the sun's size.
TEST(GhostShapes, ThroughAStarAreStarsAsLargeAsParaxialOpticsSays) {
    const SmallFeature sun = test::sun_at(0.5, 0.0002f);
    const std::vector<GhostPair> all =
        GhostOptics(test::ghostly(test::kGauss, Coating::Uncoated)).pairs();
    int tested = 0;
    for (const GhostPair pair : all) {
        const auto camera = starry(pair);
        const GhostOptics optics(camera);
        const Lens& lens = optics.lens();
        ASSERT_EQ(optics.pairs(), std::vector{pair});
        // Between the two the light comes through the iris three times.
        if (pair.second < lens.stop() && lens.stop() < pair.first) continue;
        const auto end = [&](Paraxial ray) {
            return paraxial_ghost(lens, camera->input().film_mm, pair, ray);
        };
        const ParaxialEnd by_height = end({1, 0}), by_angle = end({0, 1});
        const double scale = by_height.film / by_height.stop;
        const Iris& iris = camera->input().iris;
        const float reach_mm = iris.bounding_radius_mm();
        // Of smaller ones the sun's size blurs the tips, and larger ones leave the film.
        const double size_mm = std::fabs(scale) * double(reach_mm);
        if (size_mm < 0.7 || size_mm > 9) continue;
        SCOPED_TRACE(testing::Message() << pair.first << "," << pair.second << " " << scale);
        const V3d light = -camera->pose().local(sun.centre);
        const V2d angle = V2d(light.x, light.y) / light.z;
        const auto film_of = [&](V2f stop) {
            const V2d mm = (V2d(stop) - angle * by_angle.stop) * scale + angle * by_angle.film;
            return camera->film_of(V2f(mm));
        };
        const GhostCamera ghosts(
            nullptr, optics,
            std::make_shared<const GhostDraws>(optics, GhostRegions(optics, {&sun, 1})));
        constexpr int kCells = 16;
        constexpr uint32_t kPoints = 150000;
        std::vector<int> lit(kCells * kCells), inside(kCells * kCells), points(kCells * kCells);
        int lit_outside = 0, lit_inside = 0;
        for (uint32_t i = 0; i < kPoints; ++i) {
            const Sampler sampler(SamplerKind::Owen, 8, {0, 0, i});
            const V2f u = sampler.get2(Dim::Film), stop = (u * 2.4f - V2f(1.2f)) * reach_mm;
            const V2f film = film_of(stop);
            if (!(film.x > 0 && film.x < 1 && film.y > 0 && film.y < 1)) continue;
            const bool even = is_even(iris, stop, 0.06f * reach_mm);
            const bool open = iris.transmits(stop) > 0;
            bool is_lit = false;
            for (const CameraPath& path : ghosts.sample({film, sampler}, Bands::rgb()))
                is_lit |= path.weight[0] > 0 && test::hits(path.ray, sun);
            const size_t cell = size_t(u.y * kCells) * kCells + size_t(u.x * kCells);
            lit_outside += is_lit && even && !open;
            lit_inside += is_lit && even && open;
            lit[cell] += is_lit, inside[cell] += even && open, ++points[cell];
        }
        EXPECT_EQ(lit_outside, 0);
        EXPECT_GT(lit_inside, 500);
        int whole = 0;
        for (size_t cell = 0; cell < lit.size(); ++cell) {
            if (points[cell] == 0 || inside[cell] < points[cell]) continue;
            ++whole;
            EXPECT_GT(lit[cell], 0) << cell;
        }
        EXPECT_GT(whole, 10);
        ++tested;
    }
    EXPECT_GE(tested, 10) << tested;
}

}  // namespace
}  // namespace petzval::camera
