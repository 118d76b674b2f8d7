// SPDX-License-Identifier: Apache-2.0
// Sessions of renders: what they keep, and that what they keep changes no pixel.
#include "apps/render/render_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "io/base/error.h"
#include "io/image/output.h"
#include "tests/support/temporary_folder.h"

namespace petzval::apps {
namespace {

const io::Notice kSilent = [](const std::string&) {};

RenderRequest request_of(const char* scene = "first_light.glb") {
    RenderRequest request;
    request.scene.scene = std::filesystem::path(PETZVAL_ASSETS) / "scenes" / scene;
    request.scene.size = {24, 16};
    request.samples.count = 4;
    return request;
}

std::vector<float> values_of(const io::PictureRows& picture) {
    const size_t row = picture.layout.channels.size() * size_t(picture.layout.width);
    std::vector<float> out(row * size_t(picture.layout.height));
    for (int y = 0; y < picture.layout.height; ++y) picture.row(y, out.data() + size_t(y) * row);
    return out;
}

/// Renders a request; how many samples of all pixels were there before.
uint64_t render(RenderSession& session, const RenderRequest& request) {
    session.prepare(request, kSilent);
    const uint64_t before = session.film().taken_count();
    integrator::RenderMonitor monitor;
    EXPECT_FALSE(session.render(monitor).stopped);
    return before;
}

std::vector<float> alone(const RenderRequest& request) {
    RenderSession session(1);
    render(session, request);
    return values_of(session.light());
}

constexpr uint64_t kPixels = 24 * 16;

TEST(RenderSession, AnotherExposureKeepsTheSamples) {
    RenderSession session(2);
    RenderRequest request = request_of();
    EXPECT_EQ(render(session, request), 0u);
    const auto light = values_of(session.light()), shown = values_of(session.shown());
    request.display.exposure = ExposureRequest{false, 2};
    EXPECT_EQ(render(session, request), 4 * kPixels);
    EXPECT_EQ(values_of(session.light()), light);
    EXPECT_NE(values_of(session.shown()), shown);
}

// A prepass that somebody ends, and a scene that another session has loaded.
TEST(RenderSession, KeepsItsSceneWhenARequestIsAbandoned) {
    struct Enough {};
    RenderSession session(2);
    RenderRequest request = request_of();
    render(session, request);
    const auto* const scene = session.scene().prepared.scene.get();
    request.scene.camera.orbit_deg = 30;
    int planned = 0;
    const auto end_soon = [&](Phase phase) {
        if (phase == Phase::Planning && ++planned == 3) throw Enough();
    };
    EXPECT_THROW(session.prepare(request, kSilent, end_soon), Enough);
    EXPECT_EQ(session.scene().prepared.scene.get(), scene);
    EXPECT_EQ(render(session, request), 0u);
    EXPECT_EQ(session.scene().prepared.scene.get(), scene);
    EXPECT_EQ(values_of(session.light()), alone(request));

    RenderSession other(1);
    other.take(session.scene());
    EXPECT_EQ(render(other, request), 0u);
    EXPECT_EQ(other.scene().prepared.scene.get(), scene);
    EXPECT_EQ(values_of(other.light()), alone(request));
}

TEST(RenderSession, APoseMovesTheCameraThatIsNamedAndLeavesItsLens) {
    RenderRequest request = request_of();
    request.scene.camera.name = "0";
    RenderSession session(1);
    render(session, request);
    const CameraReport camera = session.setup().from.camera;
    const auto light = values_of(session.light());
    request.scene.camera.pose = camera.to_world;
    render(session, request);
    EXPECT_EQ(values_of(session.light()), light);
    request.scene.camera.pose = camera.to_world * M44f().translate(V3f(0.1f, 0, 0));
    render(session, request);
    EXPECT_EQ(session.setup().from.camera.yfov_deg, camera.yfov_deg);
    EXPECT_NE(values_of(session.light()), light);
}

TEST(RenderSession, MoreSamplesAreAddedToThoseThatAreThere) {
    RenderSession session(2);
    RenderRequest request = request_of();
    render(session, request);
    request.samples.count = 9;
    EXPECT_EQ(render(session, request), 4 * kPixels);
    EXPECT_EQ(values_of(session.light()), alone(request));
}

// What has other samples, or too many, is rendered anew.
TEST(RenderSession, NothingIsKeptOfOtherSamples) {
    const auto of_others = [](const auto& change) {
        RenderSession session(2);
        RenderRequest request = request_of();
        request.samples.count = 8;
        render(session, request);
        change(request);
        EXPECT_EQ(render(session, request), 0u);
        EXPECT_EQ(values_of(session.light()), alone(request));
    };
    of_others([](RenderRequest& r) { r.samples.count = 3; });
    of_others([](RenderRequest& r) {
        r.samples.count.reset(), r.samples.range = SampleRange{2, 12};
    });
    of_others([](RenderRequest& r) { r.samples.seed = 1; });
    of_others([](RenderRequest& r) { r.path.max_depth = 2; });
    of_others([](RenderRequest& r) { r.crop = Rect{0, 0, 12, 16}; });
    of_others([](RenderRequest& r) { r.layers = {Aov::Depth}; });
    of_others([](RenderRequest& r) { r.scene.background = Rgb(2.f); });
    of_others([](RenderRequest& r) { r.scene.spectral.bins = Bins{400, 100, 3}; });
}

TEST(RenderSession, AnotherCameraKeepsTheScene) {
    RenderSession session(2);
    RenderRequest request = request_of();
    render(session, request);
    const Scene* const scene = session.setup().prepared.scene.get();
    const Bvh* const bvh = session.setup().prepared.bvh.get();
    request.scene.camera.lens = "thin";
    request.scene.camera.fstop = 2.f;
    EXPECT_EQ(render(session, request), 0u);
    EXPECT_EQ(session.setup().prepared.scene.get(), scene);
    EXPECT_EQ(session.setup().prepared.bvh.get(), bvh);
    EXPECT_EQ(values_of(session.light()), alone(request));
}

TEST(RenderSession, StopsAndGoesOn) {
    RenderSession session(2);
    const RenderRequest request = request_of();
    session.prepare(request, kSilent);
    integrator::RenderMonitor stopped;
    stopped.stop = true;
    EXPECT_TRUE(session.render(stopped).stopped);
    EXPECT_LT(session.film().taken_count(), 4 * kPixels);
    integrator::RenderMonitor monitor;
    EXPECT_FALSE(session.render(monitor).stopped);
    EXPECT_EQ(values_of(session.light()), alone(request));
}

TEST(RenderSession, GoesOnAfterARequestThatFails) {
    RenderSession session(2);
    RenderRequest request = request_of();
    render(session, request);
    RenderRequest wrong = request;
    wrong.scene.scene = "not_there.glb";
    EXPECT_THROW(session.prepare(wrong, kSilent), io::InputError);
    EXPECT_EQ(render(session, request), 0u);
    EXPECT_EQ(values_of(session.light()), alone(request));
}

TEST(RenderSession, SpectraHaveStandardErrors) {
    RenderSession session(2);
    RenderRequest request = request_of();
    request.samples.count = 2 * kReplicates;
    request.scene.spectral.bins = Bins{400, 100, 3};
    render(session, request);
    const auto values = values_of(session.light());
    EXPECT_LT(*std::ranges::max_element(values), std::numeric_limits<float>::max());
}

// The file of the sky is read once: it may be gone for the frames that follow.
TEST(RenderSession, FramesShareTheirSky) {
    const test::TemporaryFolder folder;
    RenderRequest request = request_of("flying_lamp.glb");
    request.scene.environment = folder.path() / "sky.exr";
    io::Picture sky;
    sky.width = sky.full_width = 4, sky.height = sky.full_height = 2;
    sky.channels = {"R", "G", "B"};
    sky.pixels.assign(24, 3.f);
    io::write_output(*request.scene.environment, sky, {});
    request.moment.at = Moment{0.5};
    const auto expected = alone(request);

    RenderSession session(2, RenderSession::Frames::Sequence);
    request.moment.at = Moment{0};
    render(session, request);
    std::filesystem::remove(*request.scene.environment);
    request.moment.at = Moment{0.5};
    render(session, request);
    EXPECT_EQ(values_of(session.light()), expected);
}

TEST(RenderSession, FramesAreThoseOfSingleRenders) {
    RenderSession session(2, RenderSession::Frames::Sequence);
    RenderRequest request = request_of("flying_lamp.glb");
    request.scene.environment = kStudioLight;
    for (const double time_s : {0., 0.5, 0.25}) {
        request.moment.at = Moment{time_s};
        render(session, request);
        EXPECT_EQ(values_of(session.light()), alone(request)) << time_s;
    }
    RenderRequest wrong = request;
    wrong.scene.camera.lens = "no-such-lens";
    EXPECT_THROW(session.prepare(wrong, kSilent), io::InputError);
    // Another sky and another file are another sequence.
    request.scene.environment_strength = 2;
    render(session, request);
    EXPECT_EQ(values_of(session.light()), alone(request));
    request = request_of("wheels.glb");
    request.moment.at = Moment{0};
    render(session, request);
    EXPECT_EQ(values_of(session.light()), alone(request));
}

}  // namespace
}  // namespace petzval::apps
