// SPDX-License-Identifier: Apache-2.0
// What became of the lanes that the lens camera lost.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera/lens/traced_ray.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using namespace test;

// Where the fisheye's image ends: rims take rays first; beyond a field of 90 degrees rays graze the
// front surface, then are totally reflected within it, before the film point sees no stop at all.
TEST(LensLosses, AtTheFisheyesRimRaysGrazeThenAreTotallyReflected) {
    const LensCameraInput in = input_of(kFisheye, DispersionMode::Shared);
    LensCameraInput bare = in;
    bare.coating = Coating::Uncoated;
    const LensCamera camera(in), uncoated(bare);
    const double radius_mm = 1 / in.lens->prescription().surfaces.front().curvature_1_mm;
    struct Rim {
        LensLosses<uint64_t> lanes;
        double least_ahead = 1, least_cosine = 1, least_transmitted = 1;
    };
    const auto at = [&](float height_mm) {
        Rim rim;
        test::Random random(6);
        for (int i = 0; i < 4000; ++i) {
            const V2f u = random.next2(), film(0, height_mm);
            const auto drawn = camera.draw<f4>(film, u, Bands::rgb());
            const auto lossy = uncoated.draw<f4>(film, u, Bands::rgb());
            rim.lanes += drawn.losses;
            const double weight = double(drawn.weight[0]);
            EXPECT_EQ(weight > 0, drawn.losses.lost() == 0);
            if (!(weight > 0)) continue;
            const auto &o = drawn.ray.origin, &d = drawn.ray.direction;
            const V3d from_centre(o.x[0], o.y[0], double(o.z[0]) - radius_mm);
            const double cosine = from_centre.dot(V3d(d.x[0], d.y[0], d.z[0])) / radius_mm;
            const double transmitted = double(lossy.weight[0]) / weight;
            EXPECT_GE(transmitted, 0);
            EXPECT_LT(transmitted, 1);
            rim.least_ahead = std::min(rim.least_ahead, -double(d.z[0]));
            if (cosine < rim.least_cosine) {
                rim.least_cosine = cosine;
                rim.least_transmitted = transmitted;
            }
        }
        return rim;
    };
    for (const float height_mm : {18.f, 21.6f, 22.f}) {
        const Rim rim = at(height_mm);
        EXPECT_GT(rim.lanes.vignetted, rim.lanes.drawn / 50);
        EXPECT_EQ(rim.lanes.lost(), rim.lanes.vignetted) << height_mm;
        EXPECT_GT(rim.least_transmitted, 0.25) << height_mm;
        EXPECT_EQ(rim.least_ahead<0, height_mm> 21.8f) << height_mm;
    }
    const Rim last = at(23);
    EXPECT_LT(last.least_ahead, -0.25);  // 15 degrees beyond a right angle
    EXPECT_LT(last.least_cosine, 0.01);
    EXPECT_LT(last.least_transmitted, 0.02);
    EXPECT_GT(last.lanes.totally_reflected, last.lanes.drawn / 10);
    EXPECT_LT(last.lanes.lost(), last.lanes.drawn);
    for (const float height_mm : {24.f, 25.f, 28.f}) {
        const LensLosses<uint64_t> dark = at(height_mm).lanes;
        EXPECT_EQ(dark.lost(), dark.drawn) << height_mm;
        EXPECT_EQ(dark.totally_reflected > 0, height_mm < 26) << height_mm;
        EXPECT_EQ(dark.unreached > 0, height_mm > 26) << height_mm;
        EXPECT_EQ(dark.missed, 0u);
    }
}

/// Of many samples over a film. Every sample's lanes must add up.
LensLosses<uint64_t> losses(const LensCameraInput& in, Bands bands) {
    const LensCamera camera(in);
    LensLosses<uint64_t> out;
    test::Random random(6);
    for (uint32_t i = 0; i < 4000; ++i) {
        bands = led_by(bands, float(i % 4) / 4);
        const CameraSample seen = camera.sample(film_point(random.next2(), i), bands);
        uint32_t passed = 0;
        for (size_t k = 0; k < seen.size(); ++k) passed += uint32_t(lane_count(seen[k].lanes));
        EXPECT_EQ(seen.lanes.drawn, lane_count(bands.on));
        EXPECT_EQ(passed + seen.lanes.lost(), seen.lanes.drawn);
        out += seen.lanes;
    }
    return out;
}

TEST(LensLosses, AddUpAndTellTheCause) {
    for (const DispersionMode dispersion : {DispersionMode::Shared, DispersionMode::Split})
        for (const Precision precision : {Precision::Float, Precision::Double}) {
            LensCameraInput in = input_of(kTakumar, dispersion);
            in.precision = precision;
            const auto open = losses(in, four_wavelengths());
            EXPECT_GT(open.vignetted, open.drawn / 10);  // cat's eyes
            EXPECT_LT(open.vignetted, open.drawn / 2);
            // A small stop lets everything through.
            LensCameraInput small = input_of(kTakumar, dispersion, 0.2);
            small.precision = precision;
            const auto stopped = losses(small, four_wavelengths());
            EXPECT_LT(stopped.lost(), stopped.drawn / 100);  // edges of the iris, between lanes
        }
}

TEST(LensLosses, AFilmBeyondTheImageCircleIsBlack) {
    LensCameraInput in = input_of(kGauss, DispersionMode::Shared);
    in.film_width_mm = in.film_height_mm = 300;
    const auto all = losses(in, Bands::rgb());
    EXPECT_GT(all.vignetted, 0u);
    EXPECT_GT(all.unreached, all.drawn / 4);
    EXPECT_GT(all.lost(), all.drawn * 9 / 10);
}

// An iris that is larger than the stop is cut off by its rim; of a wide one, most points are
// reached by no ray. Few are drawn there: what the camera keeps for them is a 32nd.
TEST(LensLosses, AWideIrisIsVignettedOrUnreached) {
    const auto some = losses(input_of(kGauss, DispersionMode::Shared, 1.5), Bands::rgb());
    EXPECT_GT(some.vignetted, some.drawn / 64);
    EXPECT_LT(some.vignetted, some.drawn / 5);
    const auto most = losses(input_of(kGauss, DispersionMode::Shared, 20), Bands::rgb());
    EXPECT_GT(most.unreached, most.drawn / 64);
    EXPECT_LT(most.lost(), most.drawn / 5);
}

// Plane glass before the stop, steep rays within: they meet the next plane beyond the critical
// angle, or a ball that they miss.
TEST(LensLosses, TotalReflectionAndMissesAreToldApart) {
    const auto through = [](double last_curvature, double glass) {
        Prescription p;
        const auto add = [&p](double curvature, double thickness, double index, bool stop) {
            LensSurface s;
            s.curvature_1_mm = curvature;
            s.thickness_mm = thickness;
            s.semi_diameter_mm = 1000;
            s.stop = stop;
            if (index != 1) s.glass = Glass{"as given", IndexTable{{{400, index}, {700, index}}}};
            p.surfaces.push_back(std::move(s));
        };
        add(last_curvature, 5, glass, false);
        add(0, 5, glass == 1 ? 1.5 : 1, true);
        add(0, 10, 1, false);
        const auto lens = std::make_shared<const Lens>(p);
        LensCameraInput in{.lens = lens, .iris = Iris(Disk{}, 15), .to_world = M44f()};
        in.film_mm = lens->film_mm();
        in.film_width_mm = in.film_height_mm = 2;
        in.dispersion = DispersionMode::Shared;
        return losses(in, Bands::rgb());
    };
    const auto curved = through(0.1, 1.8);  // light leaves the glass through a ball of 10 mm
    EXPECT_GT(curved.missed, 0u);
    EXPECT_EQ(curved.vignetted, 0u);
    const auto concave = through(-0.04, 1.8);
    EXPECT_GT(concave.totally_reflected, 0u);
    EXPECT_EQ(concave.vignetted, 0u);
}

}  // namespace
}  // namespace petzval::camera
