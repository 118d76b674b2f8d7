// SPDX-License-Identifier: Apache-2.0
// The lens camera in doubles, and with what its surfaces reflect.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera/lens/coating.h"
#include "camera/lens/traced_ray.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using namespace test;

TEST(LensCameraPrecision, DoublesAgreeWithFloats) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kFisheye, std::string("canon-14mm-f2.8-asph")}) {
        LensCameraInput in = input_of(name);
        const LensCamera floats(in);
        in.precision = Precision::Double;
        const LensCamera camera(in);
        test::Random random(2);
        int checked = 0;
        for (uint32_t i = 0; i < 1000; ++i) {
            const FilmPoint at = film_point(random.next2(), i);
            const CameraSample a = floats.sample(at, bands), b = camera.sample(at, bands);
            if (a.size() != 4 || b.size() != 4) continue;
            ++checked;
            for (size_t k = 0; k < 4; ++k) {
                ASSERT_LT((a[k].ray.direction - b[k].ray.direction).length(), 2e-5);
                ASSERT_LT((a[k].ray.origin - b[k].ray.origin).length(), 2e-6) << name;
                ASSERT_NEAR(a[k].weight[int(k)], b[k].weight[int(k)], 1e-3f * a[k].weight[int(k)]);
            }
        }
        EXPECT_GT(checked, 300) << name;
    }
}

// Backwards through the whole lens with trace_ray, which gives the direction at the film; from
// there central differences of trace_ray say how far the iris point moves.
TEST(LensCameraPrecision, DoublesAreATracedRays) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kFisheye, std::string("canon-14mm-f2.8-asph"),
                                    std::string("schneider-anamorphic-31mm")}) {
        const LensCameraInput in = input_of(name, DispersionMode::Split, 0.9);
        const Lens& lens = *in.lens;
        const LensCamera camera(in);
        test::Random random(2);
        int checked = 0;
        for (uint32_t i = 0; i < 200; ++i) {
            const V2f film = (random.next2() - V2f(0.5f)) * 16.f, u = random.next2();
            const auto drawn = camera.draw<d4>(film, u, led_by(bands, random.next()));
            if (!all(drawn.weight > 0)) continue;
            ++checked;
            double stretches = 0;
            for (int lane = 0; lane < 4; ++lane) {
                const auto vector = [lane](const Vec3<d4>& v) {
                    return V3d(v.x[lane], v.y[lane], v.z[lane]);
                };
                const double nm = bands.nm[lane];
                const V3d origin =
                    vector(drawn.ray.origin) + V3d(0, 0, lens.vertex_mm(drawn.ray.counted_from));
                const TracedRay back = trace_ray(lens, origin, -vector(drawn.ray.direction), nm,
                                                 Towards::Film, Clip::Yes);
                ASSERT_EQ(back.status, RayStatus::Passed) << name;
                const auto met = back.at_plane(in.film_mm);
                ASSERT_TRUE(met);
                ASSERT_NEAR((*met)[0], film.x, 1e-9) << name;
                ASSERT_NEAR((*met)[1], film.y, 1e-9) << name;
                const auto at_stop = [&](double dl, double dm) {
                    V3d d = -back.direction + V3d(dl, dm, 0);
                    d.z = -std::sqrt(1 - d.x * d.x - d.y * d.y);
                    return trace_ray(lens, {film.x, film.y, in.film_mm}, d, nm, Towards::Scene,
                                     Clip::No)
                        .points[size_t(lens.last() - lens.stop())];
                };
                constexpr double kStep = 1e-5;
                const V3d by_l = (at_stop(kStep, 0) - at_stop(-kStep, 0)) / (2 * kStep);
                const V3d by_m = (at_stop(0, kStep) - at_stop(0, -kStep)) / (2 * kStep);
                stretches += std::fabs(by_l.x * by_m.y - by_l.y * by_m.x);
            }
            const double expected = in.iris.area_mm2() / (stretches / 4);
            for (int lane = 0; lane < 4; ++lane)
                ASSERT_NEAR(drawn.weight[lane] / expected, 1, 1e-6) << name;
        }
        EXPECT_GT(checked, 60) << name;
    }
}

// Share of light that passes a lens along its axis.
float axial_transmittance(const Lens& lens, Coating coating, float nm) {
    const LensIndices<f4> indices = lens.exact_indices(splat(nm));
    f4 out = splat(1.f);
    for (const auto& s : lens.surfaces<float>())
        if (s.medium_before != s.medium_after)
            out *= transmittance(
                coating,
                {indices.of_medium[s.medium_before], indices.of_medium[s.medium_after], splat(1.f)},
                touches_air(s), splat(nm));
    return out[0];
}

TEST(LensCameraCoating, LossesMultiplyTheWeight) {
    for (const std::string& name : {kGauss, kFisheye})
        for (const Coating coating : {Coating::Uncoated, Coating::MgF2}) {
            LensCameraInput in = input_of(name, DispersionMode::Split, 0.05);
            const LensCamera ideal(in);
            in.coating = coating;
            const LensCamera camera(in);
            const Bands bands = four_wavelengths();
            // A small stop on the axis: nearly normal incidence.
            const FilmPoint at = film_point({0.5f, 0.5f}, 3);
            const auto bare = draw_of(ideal, in, at, bands), lossy = draw_of(camera, in, at, bands);
            const auto precise = draw_of<d4>(camera, in, at, bands);
            for (int lane = 0; lane < 4; ++lane) {
                const float through = lossy.weight[lane] / bare.weight[lane];
                EXPECT_NEAR(through, axial_transmittance(*in.lens, coating, bands.nm[lane]), 1e-3);
                EXPECT_NEAR(through, precise.weight[lane] / bare.weight[lane], 1e-4);
            }
            EXPECT_EQ(camera.irradiance(V2f(0.f), 64), ideal.irradiance(V2f(0.f), 64));
        }
}

// Surface by surface, with angles from the points of trace_ray.
TEST(LensCameraCoating, OffTheAxisEachSurfaceHasItsAngle) {
    LensCameraInput in = input_of(kGauss, DispersionMode::Split);
    const LensCamera ideal(in);
    in.coating = Coating::Uncoated;
    const LensCamera camera(in);
    const Lens& lens = *in.lens;
    const Bands bands = four_wavelengths();
    for (uint32_t i = 0; i < 40; ++i) {
        const FilmPoint at = film_point({0.75f, 0.4f}, i);
        const auto bare = draw_of<d4>(ideal, in, at, bands),
                   lossy = draw_of<d4>(camera, in, at, bands);
        if (!all(bare.weight > 0)) continue;
        const V2f film = millimetres(in, at.film);
        for (int lane = 0; lane < 4; ++lane) {
            const double nm = bands.nm[lane];
            const auto& o = bare.ray.origin;
            const auto& d = bare.ray.direction;
            const V3d origin(o.x[lane], o.y[lane],
                             o.z[lane] + lens.vertex_mm(bare.ray.counted_from));
            const V3d away(d.x[lane], d.y[lane], d.z[lane]);
            TracedRay back = trace_ray(lens, origin, -away, nm, Towards::Film, Clip::No);
            std::vector<V3d> points{origin + away};
            points.insert(points.end(), back.points.begin(), back.points.end());
            points.emplace_back(film.x, film.y, in.film_mm);
            const auto indices = lens.exact_indices(d4{} + nm);
            double through = 1;
            for (int k = 0; k < lens.size(); ++k) {
                const auto& s = lens.surfaces<double>()[size_t(k)];
                if (s.medium_before == s.medium_after) continue;
                const V3d& p = points[size_t(k) + 1];
                V3d normal(-s.curvature_x * p.x, -s.curvature_y * p.y,
                           1 - s.curvature_z * (p.z - lens.vertex_mm(k)));
                normal.normalize();
                const auto cosine = [&](const V3d& step) { return normal.dot(step.normalized()); };
                const double c0 = cosine(p - points[size_t(k)]);
                const double c1 = cosine(points[size_t(k) + 2] - p);
                const double n0 = indices.of_medium[s.medium_before][0],
                             n1 = indices.of_medium[s.medium_after][0];
                const double rs = (n0 * c0 - n1 * c1) / (n0 * c0 + n1 * c1);
                const double rp = (n1 * c0 - n0 * c1) / (n1 * c0 + n0 * c1);
                through *= 1 - (rs * rs + rp * rp) / 2;
            }
            ASSERT_NEAR(lossy.weight[lane] / bare.weight[lane], through, 1e-5);
        }
    }
}

}  // namespace
}  // namespace petzval::camera
