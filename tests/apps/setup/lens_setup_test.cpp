// SPDX-License-Identifier: Apache-2.0
// Where a lens stands once it is focused: distances and perspective count from the middle of its
// entrance pupil, which moves with a group that focuses.
#include "apps/setup/camera/lens_setup.h"

#include <gtest/gtest.h>

#include <cmath>

namespace petzval::apps {
namespace {

// Where the rays of points near the middle of the film cross the axis, in metres in front of the
// camera's node. The middle of a narrow iris's image is the pupil's.
double pupil_m(const camera::Camera& camera) {
    double sum = 0;
    constexpr uint32_t kRays = 4096;
    for (uint32_t i = 0; i < kRays; ++i) {
        const camera::FilmPoint at{{0.75f, 0.5f}, Sampler(SamplerKind::Owen, 3, {0, 0, i})};
        const camera::CameraSample seen = camera.sample(at, Bands::rgb());
        EXPECT_EQ(seen.size(), 1u);
        const Ray& ray = seen[0].ray;
        sum += double(ray.origin.z) -
               double(ray.origin.x) * double(ray.direction.z) / double(ray.direction.x);
    }
    return -sum / kRays;
}

TEST(LensSetup, ThePupilOfTheLensInFocusStandsAtTheNode) {
    for (const char* name : {"nikkor-400mm-f2.8-fl", "double-gauss-100mm-f2"}) {
        const LoadedLens loaded = load_lens_for_film(name, {}, std::nullopt, 1.5f, std::nullopt);
        for (const float focus_m : {4.f, 10.f, 1000.f}) {
            const auto camera = viewfinder(loaded, M44f(), focus_m);
            // Pupils are not points: aberrations of the pupil leave some centimetres of a metre.
            EXPECT_NEAR(pupil_m(*camera), 0, 0.04) << name << ' ' << focus_m;
        }
    }
}

TEST(LensSetup, PixelsOfTheFilmNarrowAsTheFilmGoesBack) {
    const LoadedLens loaded =
        load_lens_for_film("double-gauss-100mm-f2", {}, std::nullopt, 1.5f, std::nullopt);
    const auto slope = [&](std::optional<float> focus_m) {
        const auto camera = viewfinder(loaded, M44f(), focus_m);
        double sum = 0;
        for (uint32_t i = 0; i < 1024; ++i) {
            const camera::FilmPoint at{{0.9f, 0.5f}, Sampler(SamplerKind::Owen, 3, {0, 0, i})};
            const V3f d = camera->sample(at, Bands::rgb())[0].ray.direction;
            sum += double(d.x) / -double(d.z) / 1024;
        }
        return sum;
    };
    // At 1 m the film of 100 mm stands 1 / (1 - 0.1) times as far away; thin, to a few per cent.
    EXPECT_NEAR(slope(1.f) / slope(std::nullopt), 0.9, 0.03);
}

}  // namespace
}  // namespace petzval::apps
