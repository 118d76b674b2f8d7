// SPDX-License-Identifier: Apache-2.0
// Rays to targets change the noise of a picture and never its mean, whatever stands between.
#include <gtest/gtest.h>

#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "camera/targets/target_grid.h"
#include "integrator/prepass/highlights.h"
#include "integrator/prepass/target_pilot.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"
#include "tests/support/traced_world.h"

namespace petzval::apps {
namespace {

using namespace test;

const V2i kSize(48, 32);
/// Quarters of the frame: ordinary rays must meet small lamps often enough for a test of means.
constexpr int kPart_px = 24 * 16;
constexpr size_t kParts = 4;
constexpr int kSeeds = 24;
constexpr uint32_t kSamples = 64;

using Means = std::array<Moments, kParts>;

/// Means of parts of the frame, over seeds.
Means rendered(const TracedWorld& world, const camera::Camera& camera, uint32_t first_seed) {
    Means out;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        integrator::RenderJob job;
        job.end_sample = kSamples;
        job.seed = first_seed + seed;
        Film film(kSize, {0, 0, kSize.x, kSize.y}, {});
        integrator::ThreadExecutor executor(1);
        integrator::RenderMonitor monitor;
        (void)integrator::render(*world.tracer, camera, job, film, executor, monitor);
        std::array<double, kParts> sums{};
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x)
                sums[static_cast<size_t>(y / (kSize.y / 2) * 2 + x / (kSize.x / 2))] +=
                    double(film.colour(x, y)[1]) / kPart_px;
        for (size_t i = 0; i < kParts; ++i) out[i].add(sums[i]);
    }
    return out;
}

double noise(const Means& means) {
    double sum = 0;
    for (const Moments& m : means) sum += m.standard_error() * m.standard_error();
    return sum;
}

/// The same means with targets, and less noise. All that is found is used, whether it pays or not.
void expect_same_mean(TracedWorld& world, const std::shared_ptr<const camera::Camera>& camera,
                      double gain, const char* what) {
    world.finish();
    std::vector<SmallFeature> features = small_features_of(world.scene);
    const auto images = integrator::highlights(*camera, world.scene, *world.bvh, kSize, features);
    features.insert(features.end(), images.begin(), images.end());
    const Means without = rendered(world, *camera, 1);
    const auto aims = camera::target_camera(camera);
    aims->set_targets(camera::find_targets(*aims, kSize, features));
    ASSERT_NE(aims->targets(), nullptr) << what;
    const Means with = rendered(world, *aims, 1000);
    EXPECT_GE(least_p(without, with), sidak(kStatisticalTests * static_cast<int>(kParts))) << what;
    EXPECT_LT(noise(with) * gain, noise(without)) << what;
}

std::shared_ptr<const camera::Camera> thin(float focus_m = 1) {
    camera::ThinLens lens;
    lens.to_world = camera::look_at(V3f(0, 0, 0), V3f(0, 0, -1));
    lens.yfov_rad = 0.3f;
    lens.iris = camera::Iris(camera::Disk{}, 20);
    lens.focus_m = focus_m;
    return std::make_shared<camera::ThinLensCamera>(lens);
}

Material mirror(float roughness) {
    Material m;
    m.base_color = Rgb(0.9f);
    m.metallic = 1;
    m.roughness = roughness;
    return m;
}

/// Smooth and thin.
Material clear(float albedo) {
    Material m = diffuse_material(albedo);
    m.roughness = 0;
    m.transmission = 1;
    m.specular = 1;
    return m;
}

/// A lamp before a wall.
void place_small_lamp(Scene& scene, const V3f& at, float radius_m = 0.006f) {
    place(scene, sphere(at, radius_m, 12, true), emitter_material(500.f));
    place(scene, quad(V3f(-2, -2, -4), V3f(4, 0, 0), V3f(0, 4, 0)), diffuse_material(0.5f));
}

TEST(TargetMeans, AreKeptForALampInTheOpen) {
    TracedWorld world;
    place_small_lamp(world.scene, V3f(0.05f, 0.02f, -3));
    const auto camera = thin();
    expect_same_mean(world, camera, 4, "a lamp");
}

// A ray to a lamp that is sharp leaves from another film point of the pixel. The number of rays
// must be that of the pixel: cells are smaller than three pixels here, and each second one sends
// eight.
TEST(TargetMeans, AreKeptForSharpLampsWhereCellsSendOneRayOrEight) {
    TracedWorld world;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x)
            place(world.scene,
                  sphere(V3f(-0.5f + 0.161f * float(x), -0.32f + 0.161f * float(y), -3), 0.006f, 12,
                         true),
                  emitter_material(500.f));
    world.finish();
    const auto camera = thin(3);
    const Means without = rendered(world, *camera, 1);
    const auto aims = camera::target_camera(camera);
    auto grid = std::make_shared<camera::TargetGrid>(
        *camera::find_targets(*aims, kSize, small_features_of(world.scene)));
    size_t sharp = 0;
    for (size_t n = 0; n < grid->lists.size(); ++n) {
        grid->lists[n].rays = n % 2 == 0 ? 1 : 8;
        for (const camera::ListedTarget& target : grid->lists[n].targets) sharp += target.is_sharp;
    }
    EXPECT_GE(sharp, 35u);
    aims->set_targets(grid);
    const Means with = rendered(world, *aims, 1000);
    EXPECT_GE(least_p(without, with), sidak(kStatisticalTests * static_cast<int>(kParts)));
    EXPECT_LT(noise(with) * 2, noise(without));
}

TEST(TargetMeans, AreKeptForAHalfHiddenLamp) {
    for (const float z : {-0.5f, -1.5f, -2.95f}) {
        TracedWorld world;
        place_small_lamp(world.scene, V3f(0.05f, 0.02f, -3));
        const float edge = 0.05f * -z / 3;
        place(world.scene, quad(V3f(edge, -1, z), V3f(1, 0, 0), V3f(0, 2, 0)),
              diffuse_material(0.3f));
        const auto camera = thin();
        expect_same_mean(world, camera, 1.5, "half hidden");
    }
}

TEST(TargetMeans, AreKeptForALampBehindAPane) {
    TracedWorld world;
    place_small_lamp(world.scene, V3f(0.05f, 0.02f, -3));
    const Material pane = clear(0.8f);
    place(world.scene, quad(V3f(-1, -1, -2), V3f(2, 0, 0), V3f(0, 2, 0)), pane);
    const auto camera = thin();
    expect_same_mean(world, camera, 4, "behind a pane");
}

TEST(TargetMeans, AreKeptForALampInAbsorbingGlass) {
    TracedWorld world;
    place_small_lamp(world.scene, V3f(0.05f, 0.02f, -3));
    Material glass = clear(1);
    glass.has_volume = true;
    glass.attenuation_color = Rgb(0.3f, 0.5f, 0.7f);
    glass.attenuation_distance_m = 0.05f;
    place(world.scene, sphere(V3f(0.05f, 0.02f, -3), 0.05f, 48, true), glass);
    const auto camera = thin();
    expect_same_mean(world, camera, 1.5, "in glass");
}

TEST(TargetMeans, AreKeptAtTheEdgeOfTheFrame) {
    TracedWorld world;
    place_small_lamp(world.scene, V3f(0.675f, 0.2f, -3));
    const auto camera = thin();
    expect_same_mean(world, camera, 2, "half outside");
}

TEST(TargetMeans, AreKeptForHighlights) {
    for (const float roughness : {0.f, 0.1f, 0.2f}) {
        TracedWorld world;
        place(world.scene, sphere(V3f(0, 0, -2.5f), 0.1f, 96, true), mirror(roughness));
        place(world.scene, sphere(V3f(0.2f, 0.4f, 1), 0.1f, 12, true), emitter_material(500.f));
        world.scene.sky = Sky::uniform(Rgb(0.1f));
        const auto camera = thin();
        expect_same_mean(world, camera, 5, "a highlight");
    }
}

// Through all surfaces, at a caustic and with a cat's eye.
TEST(TargetMeans, AreKeptThroughATracedLens) {
    for (const V2f& at : {V2f(0.1f, 0.05f), V2f(0.62f, 0.4f)}) {
        TracedWorld world;
        place_small_lamp(world.scene, V3f(at.x, at.y, -3), 0.008f);
        camera::LensCameraInput in = input_of(kTakumar);
        in.to_world = camera::look_at(V3f(0, 0, 0), V3f(0, 0, -1));
        in.film_mm += 3;
        const auto camera = std::make_shared<camera::LensCamera>(std::move(in));
        expect_same_mean(world, camera, 2, "through the Takumar");
    }
}

// A lamp that fills the frame is no target, and a lamp that nobody sees is none.
TEST(TargetMeans, LampsThatOrdinaryRaysMeetAreNoTargets) {
    for (const V3f& at : {V3f(0, 0, -3), V3f(0, 0, 3)}) {
        TracedWorld world;
        place(world.scene, sphere(at, 2.f, 24, true), emitter_material(5.f));
        world.finish();
        const auto camera = camera::target_camera(thin());
        EXPECT_EQ(camera::find_targets(*camera, kSize, small_features_of(world.scene)), nullptr);
    }
}

// The pilot leaves out what does not pay, and a thousand lamps of a pixel end in bounded lists.
TEST(TargetMeans, AThousandLampsInAPixelAreASanePicture) {
    TracedWorld world;
    for (int i = 0; i < 1000; ++i)
        place(world.scene,
              sphere(V3f(1e-4f * float(i % 32), 1e-4f * float(i / 32), -3), 2e-5f, 3, false),
              emitter_material(1e6f));
    world.finish();
    const auto camera = camera::target_camera(thin());
    camera->set_targets(camera::find_targets(*camera, kSize, small_features_of(world.scene, 1024)));
    ASSERT_NE(camera->targets(), nullptr);
    for (const camera::TargetCell& cell : camera->targets()->lists)
        EXPECT_LE(cell.targets.size(), camera::TargetCell::kMostTargets);
    camera->set_targets(
        integrator::targets_that_pay(*camera, world.scene, *world.bvh, *world.lights, kSize));
    for (const Moments& part : rendered(world, *camera, 1)) EXPECT_TRUE(std::isfinite(part.mean()));
}

}  // namespace
}  // namespace petzval::apps
