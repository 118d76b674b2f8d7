// SPDX-License-Identifier: Apache-2.0
// What the lens camera hands to the integrator: rays in the world, lanes, weights.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera/lens/traced_ray.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using namespace test;

// The double Gauss is focused at infinity, where a film point is a direction.
TEST(LensCameraSample, RaysLeaveThePupilTowardsWhatIsSeenThere) {
    const LensCameraInput in = input_of(kGauss, DispersionMode::Shared, 0.3);
    const LensCamera camera(in);
    const double focal_mm = first_order(*in.lens, kLineD_nm).focal_length_mm;
    const V3f back(-0.48f, 0.6f, 0.64f), up(0.36f, 0.8f, -0.48f), right = up.cross(back);
    for (const V2f& film : {V2f(0.5f, 0.5f), V2f(0.9f, 0.5f), V2f(0.5f, 0.1f), V2f(0.2f, 0.8f)})
        for (uint32_t i = 0; i < 64; ++i) {
            const CameraSample seen = camera.sample(film_point(film, i), Bands::rgb());
            ASSERT_EQ(seen.size(), 1u);
            const Ray& ray = seen[0].ray;
            EXPECT_NEAR(ray.direction.length(), 1, 1e-6);
            // Right on the film is right in the scene; its top is up.
            const float ahead = -ray.direction.dot(back);
            EXPECT_NEAR(ray.direction.dot(right) / ahead, (film.x - 0.5) * 36 / focal_mm, 2e-3);
            EXPECT_NEAR(ray.direction.dot(up) / ahead, (0.5 - film.y) * 24 / focal_mm, 2e-3);
            // In metres, through the entrance pupil, whose middle stands at the pose.
            const V3f from = ray.origin - V3f(1, 2, 3);
            const V3f in_pupil = from - ray.direction * (from.dot(back) / ray.direction.dot(back));
            EXPECT_LT(in_pupil.length(), 0.3 * 0.025 * 1.1);
        }
}

TEST(LensCameraSample, LanesOfPathsPartitionThoseThatPass) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kFisheye})
        for (const DispersionMode dispersion : {DispersionMode::Shared, DispersionMode::Split}) {
            const LensCameraInput in = input_of(name, dispersion);
            const LensCamera camera(in);
            test::Random random(3);
            std::array<int, 5> counts{};
            for (uint32_t i = 0; i < 2000; ++i) {
                const FilmPoint at = film_point(random.next2(), i);
                const LensDraw<f4> drawn = draw_of(camera, in, at, bands);
                const CameraSample seen = camera.sample(at, bands);
                ++counts[seen.size()];
                f4 weight{};
                m4 lanes{};
                for (size_t k = 0; k < seen.size(); ++k) {
                    const CameraPath& path = seen[k];
                    ASSERT_GT(lane_count(path.lanes), 0);
                    ASSERT_EQ(lane_count(path.lanes & lanes), 0);
                    lanes |= path.lanes;
                    weight += path.weight;
                }
                const m4 passed = drawn.weight > 0.f;
                for (int lane = 0; lane < 4; ++lane) {
                    ASSERT_EQ(lanes[lane], passed[lane]);
                    ASSERT_EQ(weight[lane], drawn.weight[lane]);
                }
                if (dispersion == DispersionMode::Split) {
                    ASSERT_EQ(int(seen.size()), lane_count(passed));
                }
            }
            EXPECT_EQ(counts[1] + counts[0] == 2000, dispersion == DispersionMode::Shared);
            if (dispersion == DispersionMode::Split) {
                EXPECT_GT(counts[4], 1000) << name;
            }
        }
}

TEST(LensCameraSample, OneWavelengthAPathIsAllInTheMean) {
    Bands bands = four_wavelengths();
    const auto mean = [&](bool one_by_one) {
        const LensCamera camera(input_of(kTakumar, DispersionMode::Split, 0.5));
        std::array<test::Moments, 4> out;
        for (uint32_t i = 0; i < 1 << 14; ++i) {
            bands.hero = int(hash32(i) % 4);
            const CameraSample seen =
                camera.sample(film_point({0.8f, 0.3f}, i), one_by_one ? alone(bands) : bands);
            f4 weight{};
            for (size_t k = 0; k < seen.size(); ++k)
                weight += one_by_one ? 4 * seen[k].weight : seen[k].weight;
            for (size_t lane = 0; lane < 4; ++lane) out[lane].add(weight[int(lane)]);
        }
        return out;
    };
    const auto single = mean(true), split = mean(false);
    // Owen's points are better than independent ones, so that the errors are overestimates.
    for (size_t lane = 0; lane < 4; ++lane) {
        const test::Mean off = test::Mean(single[lane]) - test::Mean(split[lane]);
        EXPECT_LT(off.error, 0.03 * split[lane].mean());
        EXPECT_TRUE(test::agrees(off, 0)) << off;
    }
}

TEST(LensCameraSample, ExposureIsInTheWeight) {
    const LensCameraInput in = input_of(kGauss, DispersionMode::Shared);
    LensCamera camera(in);
    const FilmPoint at = film_point({0.5f, 0.5f}, 1);
    const float before = camera.sample(at, Bands::rgb())[0].weight[0];
    camera.set_exposure(2, 1);
    EXPECT_FLOAT_EQ(camera.sample(at, Bands::rgb())[0].weight[0], 2 * before);
}

}  // namespace
}  // namespace petzval::camera
