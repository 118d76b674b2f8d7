// SPDX-License-Identifier: Apache-2.0
// From a file that moves to a picture: set up with a shutter, and as stills.
#include <gtest/gtest.h>

#include "apps/setup/render_setup.h"
#include "tests/support/blurred.h"
#include "tests/support/moving_gltf.h"

namespace petzval {
namespace {

using namespace test;

constexpr double kAt = 0.5, kOpen = 0.6;
constexpr V2i kSize(8, 6);

/// A body that swings before a wall, lit by a lamp that flies, and a camera that turns.
TinyGltf file_with(json camera) {
    TinyGltf file;
    const int body = file.add_mesh(
        {{"attributes",
          {{"POSITION", file.add_positions({-1, -0.2f, 0, 1, -0.2f, 0, 1, 0.2f, 0, -1, 0.2f, 0})}}},
         {"indices", file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3})},
         {"material", file.add("materials", {{"doubleSided", true}})}});
    const int wall = file.add_root({{"mesh", body}, {"scale", {4, 16, 1}}});
    file.json["nodes"][wall]["translation"] = {0, 0, -1};
    spin(file, file.add_root({{"mesh", body}}), V3d(0, 0, 1), 300);
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 30}}};
    const int lamp = file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    animate(file, lamp, "translation", {0, 1}, {-2, 1, 2, 2, 1, 2});
    file.add("cameras", std::move(camera));
    const int head = file.add_root({{"camera", 0}});
    animate(file, head, "translation", {0, 1}, {0, 0, 4, 0.6f, 0.3f, 3.5f});
    spin(file, head, V3d(0, 0, 1), 25);
    return file;
}
const json kPerspective{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}};
const json kOrthographic{
    {"type", "orthographic"},
    {"orthographic", {{"xmag", 1.5}, {"ymag", 1.5}, {"znear", 0.1}, {"zfar", 9}}}};

struct Saved {
    TempFolder folder;
    SceneRequest request;

    explicit Saved(const TinyGltf& file) {
        request.scene = file.save_glb(folder.path / "moves.glb");
        request.size = kSize;
        request.targets = TargetUse::Off;
        request.spectral.mode = SpectralMode::Rgb;
    }
    [[nodiscard]] SceneRequest at(double time_s, bool opens) const {
        SceneRequest out = request;
        out.choices.animation = AnimationChoice{time_s, {}, false, opens ? kOpen : 0};
        if (opens) out.camera.shutter_curve = ShutterCurve::box();
        return out;
    }
};

RenderSetup set_up(const SceneRequest& request) {
    return set_up_render(request, [](const std::string&) {});
}

std::vector<float> picture(const RenderSetup& setup, uint32_t spp, uint32_t seed) {
    const PreparedScene& p = setup.prepared;
    PathOptions options;
    options.max_depth = 2;
    const PathTracer<> tracer(*p.scene, *p.bvh, *p.lights, options);
    RenderJob job;
    job.end_sample = spp;
    job.seed = seed;
    job.observer = setup.view.observer;
    job.filter = Filter(FilterKind::Box, 0.5f);
    Film film(kSize, {0, 0, kSize.x, kSize.y}, {});
    ThreadExecutor executor(1);
    RenderMonitor monitor;
    (void)render(tracer, *setup.view.camera, job, film, executor, monitor);
    std::vector<float> out;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) out.push_back(film.colour(x, y)[1]);
    return out;
}

void expect_mean_of_stills(const Saved& saved) {
    const RenderSetup open = set_up(saved.at(kAt, true));
    ASSERT_NE(open.view.camera->shutter(), nullptr);
    Pixels blurred_pixels, stills;
    Random random(9);
    for (uint32_t seed = 0; seed < 12; ++seed) {
        add(blurred_pixels, picture(open, 128, seed));
        std::vector<float> mean(size_t(kSize.x * kSize.y));
        constexpr int kTimes = 12;
        for (int i = 0; i < kTimes; ++i) {
            const double time = (i + double(random.next())) / kTimes;
            const RenderSetup still = set_up(saved.at(kAt + (time - 0.5) * kOpen, false));
            EXPECT_EQ(still.view.camera->shutter(), nullptr);
            const auto one = picture(still, 8, 500 + seed * kTimes + uint32_t(i));
            for (size_t k = 0; k < mean.size(); ++k) mean[k] += one[k] / float(kTimes);
        }
        add(stills, mean);
    }
    EXPECT_TRUE(same_picture(blurred_pixels, stills));
}

TEST(MotionSetup, APinholeThatMovesGivesTheMeanOfItsStills) {
    expect_mean_of_stills(Saved(file_with(kPerspective)));
}

TEST(MotionSetup, AnOrthographicCameraThatMovesGivesTheMeanOfItsStills) {
    expect_mean_of_stills(Saved(file_with(kOrthographic)));
}

TEST(MotionSetup, AThinLensThatMovesGivesTheMeanOfItsStills) {
    Saved saved(file_with(kPerspective));
    saved.request.camera.lens = "thin";
    saved.request.camera.fstop = 1.f;
    saved.request.camera.focus = FocusDistance{2};
    expect_mean_of_stills(saved);
}

TEST(MotionSetup, ACameraThatTheUserPlacesStandsStill) {
    Saved saved(file_with(kPerspective));
    saved.request.camera.look_at = std::array{V3f(0.3f, 0, 4), V3f(0.3f, 0, 0)};
    expect_mean_of_stills(saved);
    const RenderSetup open = set_up(saved.at(kAt, true));
    ASSERT_NE(open.view.camera->shutter(), nullptr);
    Ray ray;
    ray.origin = V3f(1, 2, 3);
    ray.direction = V3f(0, 0, -1);
    ray.time = 0;
    open.view.camera->shutter()->move(ray);
    EXPECT_EQ(ray.origin, V3f(1, 2, 3));
}

TEST(MotionSetup, AnotherViewOfTheSceneHasAShutterToo) {
    const Saved saved(file_with(kPerspective));
    const RenderSetup first = set_up(saved.at(kAt, true));
    SceneRequest other = saved.at(kAt, true);
    other.camera.look_at = std::array{V3f(0, 0, 4), V3f(0.f)};
    const RenderSetup second = set_up_view(first, other, [](const std::string&) {});
    EXPECT_EQ(second.prepared.scene, first.prepared.scene);
    ASSERT_NE(second.view.camera->shutter(), nullptr);
}

TEST(MotionSetup, ACameraThatAloneMovesHasAShutter) {
    TinyGltf file = file_with(kPerspective);
    json& channels = file.json["animations"][0]["channels"];
    std::erase_if(channels.get_ref<json::array_t&>(), [&](const json& channel) {
        return !file.json["nodes"][channel["target"]["node"].get<size_t>()].contains("camera");
    });
    const Saved saved(file);
    const RenderSetup open = set_up(saved.at(kAt, true));
    EXPECT_FALSE(has_motion(*open.prepared.scene));
    EXPECT_NE(open.view.camera->shutter(), nullptr);
}

TEST(MotionSetup, NothingThatMovesHasNoShutter) {
    TinyGltf file = file_with(kPerspective);
    file.json.erase("animations");
    const Saved saved(file);
    EXPECT_EQ(set_up(saved.at(kAt, true)).view.camera->shutter(), nullptr);
    const Saved moves(file_with(kPerspective));
    EXPECT_EQ(set_up(moves.at(kAt, false)).view.camera->shutter(), nullptr);
}

}  // namespace
}  // namespace petzval
