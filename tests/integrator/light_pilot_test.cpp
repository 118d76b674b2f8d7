// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/light_pilot.h"

#include <gtest/gtest.h>

#include "camera/models/thin_lens.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "tests/support/statistics.h"
#include "tests/support/traced_world.h"

namespace petzval::integrator {
namespace {

using namespace test;

const V2i kSize(24, 16);

// A closed box with a small lamp within, and a bright sky around it that no path can reach.
struct ClosedRoom : World {
    std::unique_ptr<camera::Camera> camera;

    ClosedRoom() {
        const Material wall = diffuse_material(0.5f);
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-2.f, 2.f}) {
                V3f corner(-2.f), u(0.f), v(0.f);
                corner[axis] = side;
                u[(axis + 1) % 3] = 4;
                v[(axis + 2) % 3] = 4;
                place(scene, quad(corner, u, v), wall);
            }
        place(scene, quad(V3f(-0.3f, 1.9f, -0.3f), V3f(0, 0, 0.6f), V3f(0.6f, 0, 0)),
              emitter_material(5.f));
        std::vector<float> sky(3 * 16 * 8, 1.f);
        sky[3 * 20] = 1000.f;
        scene.sky = Sky::picture(sky, 16, 8, 0.f, 1.f);
        finish();
        lights = std::make_unique<LightChoice>(scene, LightChoiceKind::Tree);
        camera::ThinLens lens;
        lens.to_world = camera::look_at(V3f(0, 0, 1.8f), V3f(0, -0.5f, 0));
        lens.aspect = 1.5f;
        lens.iris = camera::Iris(camera::Disk{}, 50);
        lens.focus_m = 3;
        camera = std::make_unique<camera::ThinLensCamera>(lens);
    }
    [[nodiscard]] LightChoice fitted() const {
        return fitted_by_pilot(*lights, scene, *bvh, *camera, Observer(), kSize);
    }
};

struct Statistics {
    double mean = 0, standard_error = 0;  ///< of the picture's mean
    double variance = 0;                  ///< over seeds, of all pixels together
};

Statistics picture(const ClosedRoom& room, const LightChoice& choice) {
    const PathTracer<> tracer(room.scene, *room.bvh, choice, {});
    constexpr int seeds = 32;
    test::Moments means;
    Statistics found;
    std::vector<std::vector<double>> pixels;
    for (int seed = 0; seed < seeds; ++seed) {
        RenderJob job;
        job.end_sample = 16;
        job.seed = static_cast<uint32_t>(seed);
        Film film(kSize, {0, 0, kSize.x, kSize.y}, {});
        ThreadExecutor executor(1);
        RenderMonitor monitor;
        (void)render(tracer, *room.camera, job, film, executor, monitor);
        pixels.emplace_back();
        double sum = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                pixels.back().push_back(double(film.colour(x, y)[1]));
                sum += pixels.back().back();
            }
        means.add(sum / static_cast<double>(pixels.back().size()));
    }
    for (size_t i = 0; i < pixels[0].size(); ++i) {
        double at = 0;
        for (const auto& p : pixels) at += p[i] / seeds;
        for (const auto& p : pixels) found.variance += (p[i] - at) * (p[i] - at) / (seeds - 1);
    }
    found.mean = means.mean();
    found.standard_error = means.standard_error();
    return found;
}

TEST(LightPilot, ASkyThatNobodySeesHardlyCounts) {
    const ClosedRoom room;
    const LightReceiver floor{V3f(0.5f, -2, 0.5f), V3f(0, 1, 0), false};
    const auto sky = static_cast<uint32_t>(room.scene.sky_light);
    EXPECT_GT(room.lights->probability(sky, floor), 0.9f) << "as if nothing stood before it";
    const LightChoice fitted = room.fitted();
    EXPECT_LT(fitted.probability(sky, floor), 0.06f);
    EXPECT_GT(fitted.probability(sky, floor), 0.04f);
    // The same picture with less noise: light of the lamp is found 20 times as often.
    const auto before = picture(room, *room.lights), after = picture(room, fitted);
    EXPECT_NEAR(after.mean, before.mean,
                4 * std::hypot(after.standard_error, before.standard_error));
    EXPECT_LT(after.standard_error, 0.02 * after.mean);
    EXPECT_LT(after.variance, before.variance / 3);
}

// Another view of the scene starts from what an earlier one learned, and learns the same.
TEST(LightPilot, ForgetsWhatAnEarlierOneTaught) {
    ClosedRoom room;
    const LightChoice one = room.fitted();
    room.lights = std::make_unique<LightChoice>(one);
    const LightChoice two = room.fitted();
    const auto sky = static_cast<uint32_t>(room.scene.sky_light);
    for (const V3f& p : {V3f(0, -2, 0), V3f(1, -2, -1), V3f(-1.5f, -2, 1)})
        EXPECT_EQ(one.probability(sky, {p, V3f(0, 1, 0), false}),
                  two.probability(sky, {p, V3f(0, 1, 0), false}));
}

TEST(LightPilot, LeavesOtherChoicesAlone) {
    ClosedRoom room;
    room.lights = std::make_unique<LightChoice>(room.scene, LightChoiceKind::Power);
    const LightReceiver floor{V3f(0.5f, -2, 0.5f), V3f(0, 1, 0), false};
    const auto sky = static_cast<uint32_t>(room.scene.sky_light);
    EXPECT_EQ(room.fitted().probability(sky, floor), room.lights->probability(sky, floor));
}

}  // namespace
}  // namespace petzval::integrator
