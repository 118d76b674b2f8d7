// SPDX-License-Identifier: Apache-2.0
// From a file that moves to a picture: set up with a shutter, and as stills.
#include <gtest/gtest.h>

#include "apps/setup/render_setup.h"
#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "integrator/prepass/light_pilot.h"
#include "tests/support/blurred.h"
#include "tests/support/moving_gltf.h"

namespace petzval::apps {
namespace {

using namespace test;

constexpr double kMoment_s = 0.5, kMomentOpen_s = 0.6;
constexpr V2i kSmall_px(8, 6);

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
        request.size = kSmall_px;
        request.targets = TargetUse::Off;
        request.spectral.mode = SpectralMode::Rgb;
    }
    [[nodiscard]] SceneRequest at(double time_s, bool opens) const {
        SceneRequest out = request;
        out.choices.animation = io::AnimationChoice{time_s, {}, false, opens ? kMomentOpen_s : 0};
        if (opens) out.camera.shutter_curve = camera::ShutterCurve::box();
        return out;
    }
};

RenderSetup set_up(const SceneRequest& request) {
    return set_up_render(request, [](const std::string&) {});
}

std::vector<float> picture(const RenderSetup& setup, uint32_t spp, uint32_t seed) {
    const PreparedScene& p = setup.prepared;
    integrator::PathOptions options;
    options.max_depth = 2;
    const integrator::PathTracer<> tracer(*p.scene, *p.bvh, *p.lights, options);
    integrator::RenderJob job;
    job.end_sample = spp;
    job.seed = seed;
    job.observer = setup.view.observer;
    job.filter = Filter(FilterKind::Box, 0.5f);
    Film film(kSmall_px, {0, 0, kSmall_px.x, kSmall_px.y}, {});
    integrator::ThreadExecutor executor(1);
    integrator::RenderMonitor monitor;
    (void)integrator::render(tracer, *setup.view.camera, job, film, executor, monitor);
    std::vector<float> out;
    for (int y = 0; y < kSmall_px.y; ++y)
        for (int x = 0; x < kSmall_px.x; ++x) out.push_back(film.colour(x, y)[1]);
    return out;
}

void expect_mean_of_stills(const Saved& saved) {
    const RenderSetup open = set_up(saved.at(kMoment_s, true));
    ASSERT_NE(open.view.shutter, nullptr);
    Pixels blurred_pixels, stills;
    Random random(9);
    for (uint32_t seed = 0; seed < 12; ++seed) {
        add(blurred_pixels, picture(open, 128, seed));
        std::vector<float> mean(size_t(kSmall_px.x * kSmall_px.y));
        constexpr int kTimes = 12;
        for (int i = 0; i < kTimes; ++i) {
            const double time = (i + double(random.next())) / kTimes;
            const RenderSetup still =
                set_up(saved.at(kMoment_s + (time - 0.5) * kMomentOpen_s, false));
            EXPECT_EQ(still.view.shutter, nullptr);
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
    const RenderSetup open = set_up(saved.at(kMoment_s, true));
    ASSERT_NE(open.view.shutter, nullptr);
    Ray ray;
    ray.origin = V3f(1, 2, 3);
    ray.direction = V3f(0, 0, -1);
    ray.time = 0;
    open.view.shutter->move(ray);
    EXPECT_EQ(ray.origin, V3f(1, 2, 3));
}

TEST(MotionSetup, AnotherViewOfTheSceneHasAShutterToo) {
    const Saved saved(file_with(kPerspective));
    const RenderSetup first = set_up(saved.at(kMoment_s, true));
    SceneRequest other = saved.at(kMoment_s, true);
    other.camera.look_at = std::array{V3f(0, 0, 4), V3f(0.f)};
    const RenderSetup second = set_up_view(first, other, [](const std::string&) {});
    EXPECT_EQ(second.prepared.scene, first.prepared.scene);
    ASSERT_NE(second.view.shutter, nullptr);
}

TEST(MotionSetup, ACameraThatAloneMovesHasAShutter) {
    TinyGltf file = file_with(kPerspective);
    json& channels = file.json["animations"][0]["channels"];
    std::erase_if(channels.get_ref<json::array_t&>(), [&](const json& channel) {
        return !file.json["nodes"][channel["target"]["node"].get<size_t>()].contains("camera");
    });
    const Saved saved(file);
    const RenderSetup open = set_up(saved.at(kMoment_s, true));
    EXPECT_FALSE(has_motion(*open.prepared.scene));
    EXPECT_NE(open.view.shutter, nullptr);
}

/// The file with a camera whose view alone is animated besides.
TinyGltf zooming(const json& camera, const char* pointer, float first, float last) {
    TinyGltf file = file_with(camera);
    json& animation = file.json["animations"][0];
    animation["samplers"].push_back(
        {{"input", file.add_accessor<float>("SCALAR", {0, 1})},
         {"output", file.add_accessor<float>("SCALAR", {first, last})}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1},
         {"target",
          {{"path", "pointer"},
           {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    return file;
}
constexpr const char* kYfov = "/cameras/0/perspective/yfov";

TEST(MotionSetup, APinholeThatZoomsGivesTheMeanOfItsStills) {
    Saved saved(zooming(kPerspective, kYfov, 0.3f, 1.3f));
    saved.request.camera.natural_vignetting = true;
    expect_mean_of_stills(saved);
}

TEST(MotionSetup, AnOrthographicCameraThatZoomsGivesTheMeanOfItsStills) {
    expect_mean_of_stills(Saved(zooming(kOrthographic, "/cameras/0/orthographic/ymag", 0.4f, 3.f)));
}

// The iris widens with the focal length, and the light on the film changes with both.
TEST(MotionSetup, AThinLensThatZoomsGivesTheMeanOfItsStills) {
    Saved saved(zooming(kPerspective, kYfov, 0.3f, 1.3f));
    saved.request.camera.lens = "thin";
    saved.request.camera.fstop = 0.5f;
    saved.request.camera.focus = FocusDistance{3};
    saved.request.camera.exposure = ExposureMode::Photographic;
    saved.request.camera.iso = 1e4f;
    saved.request.targets = TargetUse::Auto;  // none for such a camera
    expect_mean_of_stills(saved);
    EXPECT_EQ(camera::target_camera(set_up(saved.at(kMoment_s, true)).view.still), nullptr);
}

/// The light of a wall's part above a height, through a camera whose angle of view grows evenly.
TEST(MotionSetup, AnEdgeThroughAZoomIsBlurredByTheClosedForm) {
    TinyGltf file;
    const int wall = file.add_mesh(
        {{"attributes",
          {{"POSITION", file.add_positions({-9, 0.5f, -1, 9, 0.5f, -1, 9, 9, -1, -9, 9, -1})}}},
         {"indices", file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3})},
         {"material", file.add("materials", {{"emissiveFactor", {1, 1, 1}}})}});
    file.add_root({{"mesh", wall}});
    file.add("cameras", kPerspective);
    file.add_root({{"camera", 0}});
    const double first = 0.8, last = 1.6;
    const int times = file.add_accessor<float>("SCALAR", {0, 1});
    const int angles = file.add_accessor<float>("SCALAR", {float(first), float(last)});
    file.add("animations",
             {{"samplers", {{{"input", times}, {"output", angles}}}},
              {"channels",
               {{{"sampler", 0},
                 {"target",
                  {{"path", "pointer"},
                   {"extensions", {{"KHR_animation_pointer", {{"pointer", kYfov}}}}}}}}}}});
    const Saved saved(file);
    SceneRequest request = saved.at(0.5, true);
    request.choices.animation->open_s = 1;
    request.background = Rgb(0.f);
    const RenderSetup open = set_up(request);
    ASSERT_NE(open.view.shutter, nullptr);
    constexpr uint32_t kSamples = 4096;
    const std::vector<float> found = picture(open, kSamples, 1);
    int partly = 0;
    for (int y = 0; y < kSmall_px.y; ++y) {
        // A height h of the film, 1 at the picture's rim, sees the wall while h tan(angle / 2) is
        // above a half.
        double share = 0;
        constexpr int kHeights = 4000;
        for (int i = 0; i < kHeights; ++i) {
            const double h = 1 - 2 * (y + (i + 0.5) / kHeights) / kSmall_px.y;
            if (h <= 0) continue;
            const double from = (2 * std::atan(0.5 / h) - first) / (last - first);
            share += std::clamp(1 - from, 0., 1.) / kHeights;
        }
        partly += share > 0.05 && share < 0.95;
        // 5 standard errors of as many independent samples, and a thousandth for the time steps.
        const double tolerance = 5 * std::sqrt(share * (1 - share) / kSamples) + 1e-3;
        for (int x = 0; x < kSmall_px.x; ++x)
            EXPECT_NEAR(found[size_t(y * kSmall_px.x + x)], share, tolerance) << x << ' ' << y;
    }
    EXPECT_GE(partly, 2);
}

TEST(MotionSetup, ALensThatCannotZoomIsHeldAndSaysSo) {
    const Saved saved(zooming(kPerspective, kYfov, 0.3f, 1.3f));
    const auto told = [](const SceneRequest& request) {
        std::string all;
        (void)set_up_render(request, [&](const std::string& line) { all += line + '\n'; });
        return all.find("its lens cannot: the angle of view stays") != all.npos;
    };
    SceneRequest asked = saved.at(kMoment_s, true);
    EXPECT_FALSE(told(asked));
    asked.camera.focus = FocusDistance{2};
    asked.camera.fstop = 8;
    EXPECT_FALSE(told(asked));
    asked.camera.lens = "singlet:N-BK7";
    EXPECT_TRUE(told(asked));
    asked.camera.fov_deg = 40;  // not the file's
    EXPECT_FALSE(told(asked));
    asked.camera.fov_deg = {};
    asked.camera.lens = "tessar-100mm-f2.8";
    EXPECT_FALSE(told(asked));
    asked.camera.fit = Fit::Fov;
    EXPECT_TRUE(told(asked));
    asked.camera.shutter_curve = {};
    EXPECT_FALSE(told(asked));
}

TEST(MotionSetup, AnAngleThatTheUserGivesDoesNotZoom) {
    const Saved saved(zooming(kPerspective, kYfov, 0.3f, 1.3f));
    SceneRequest asked = saved.at(kMoment_s, true);
    asked.camera.fov_deg = 40;
    EXPECT_NE(dynamic_cast<const camera::ThinLensCamera*>(set_up(asked).view.still.get()), nullptr);
    asked.camera.fov_deg = {};
    EXPECT_EQ(dynamic_cast<const camera::ThinLensCamera*>(set_up(asked).view.still.get()), nullptr);
}

TEST(MotionSetup, NothingThatMovesHasNoShutter) {
    TinyGltf file = file_with(kPerspective);
    file.json.erase("animations");
    const Saved saved(file);
    EXPECT_EQ(set_up(saved.at(kMoment_s, true)).view.shutter, nullptr);
    const Saved moves(file_with(kPerspective));
    EXPECT_EQ(set_up(moves.at(kMoment_s, false)).view.shutter, nullptr);
}

// The pilot that weighs sky and lamps sees what the moving camera sees, not only its middle.
TEST(MotionSetup, LightSharesAreThoseOfTheMovingCamera) {
    Saved saved(file_with(kPerspective));
    saved.request.environment = "studio";
    const RenderSetup open = set_up(saved.at(kMoment_s, true));
    ASSERT_NE(open.view.shutter, nullptr);
    const Scene& scene = *open.prepared.scene;
    const LightChoice before(scene, LightChoiceKind::Tree);
    ASSERT_TRUE(before.divides());
    const auto learned = [&](const camera::Camera& camera) {
        const LightChoice fitted = integrator::fitted_by_pilot(
            before, scene, *open.prepared.bvh, camera, open.view.observer, kSmall_px);
        const auto factors = fitted.shares().factors();
        return std::vector<float>(factors.begin(), factors.end());
    };
    const auto factors = open.prepared.lights->shares().factors();
    const std::vector<float> found(factors.begin(), factors.end());
    EXPECT_EQ(found, learned(*open.view.camera));
    EXPECT_NE(found, learned(*open.view.still));
}

}  // namespace
}  // namespace petzval::apps
