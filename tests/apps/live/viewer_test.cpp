// SPDX-License-Identifier: Apache-2.0
// View finders: what is seen is the last that was asked for, and what is saved has the bytes of a
// render by itself.
#include "apps/live/viewer.h"

#include <gtest/gtest.h>

#include "io/base/error.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace petzval::apps {
namespace {

using namespace std::chrono_literals;

RenderRequest request_of() {
    RenderRequest request;
    request.scene.scene = std::filesystem::path(PETZVAL_ASSETS) / "scenes/first_light.glb";
    request.scene.size = {48, 32};
    request.samples.count = 4;
    return request;
}

/// Waits until a request is done or has failed; fails after a minute.
LiveStatus end_of(const Viewer& viewer, uint64_t version) {
    LiveStatus now;
    for (const auto start = std::chrono::steady_clock::now();
         std::chrono::steady_clock::now() < start + 60s;) {
        now = viewer.wait(now.number, 100ms);
        if (now.version == version &&
            (now.stage == LiveStage::Done || now.stage == LiveStage::Failed))
            return now;
    }
    ADD_FAILURE() << "version " << version << " is never done";
    return now;
}

std::vector<uint8_t> file_of(const RenderRequest& request, const std::filesystem::path& file) {
    RenderSession session(1);
    session.prepare(request, [](const std::string&) {});
    integrator::RenderMonitor monitor;
    session.render(monitor);
    session.write(file);
    return test::read_bytes(file);
}

TEST(LiveViewer, ShowsARoughPictureThenTheTrueOne) {
    Viewer viewer(2, {});
    EXPECT_EQ(viewer.picture(), nullptr);
    RenderRequest request = request_of();
    request.scene.size = {480, 320};
    request.samples.count = 16;
    viewer.ask(1, request);
    std::vector<LiveStage> stages;
    LiveStatus now;
    while (now.stage != LiveStage::Done && now.stage != LiveStage::Failed) {
        now = viewer.wait(now.number, 60s);
        if (stages.empty() || stages.back() != now.stage) stages.push_back(now.stage);
        if (now.stage == LiveStage::Rough) {
            EXPECT_LT(viewer.picture()->size_px.x, 480);
        }
    }
    EXPECT_EQ(now.stage, LiveStage::Done) << now.error;
    EXPECT_EQ(stages.back(), LiveStage::Done);
    EXPECT_NE(std::ranges::find(stages, LiveStage::Rough), stages.end());
    EXPECT_EQ(viewer.picture()->size_px, request.scene.size);
    EXPECT_EQ(viewer.picture()->rgba.size(), 480u * 320 * 4);
    EXPECT_EQ(now.samples, 16u);
    ASSERT_TRUE(now.camera.has_value());
    EXPECT_GT(now.camera->middle_m, 0);
}

// As a hand does: each change comes while the picture before is under way.
TEST(LiveViewer, AfterAHundredChangesTheFileIsThatOfARenderByItself) {
    const test::TemporaryFolder folder;
    Viewer viewer(2, {});
    RenderRequest request = request_of();
    test::Random random(5);
    for (uint64_t version = 1; version <= 100; ++version) {
        switch (static_cast<int>(8 * random.next())) {
            case 0:
                request.scene.camera.orbit_deg = 360 * random.next();
                break;
            case 1:
                request.scene.camera.fstop = 1 + 10 * random.next();
                break;
            case 2:
                request.scene.camera.lens = "takumar-50mm-f1.2";
                break;
            case 3:
                request.scene.camera.lens = "pinhole";
                break;
            case 4:
                request.display.exposure = ExposureRequest{false, random.next()};
                break;
            case 5:
                request.samples.count = 1 + static_cast<uint32_t>(8 * random.next());
                break;
            case 6:
                request.scene.camera.focus = FocusPixel{24, 16};
                break;
            default:
                request.scene.camera.fov_deg = 20 + 40 * random.next();
                break;
        }
        if (request.scene.camera.lens != "takumar-50mm-f1.2") {
            request.scene.camera.fstop.reset();
            request.scene.camera.focus.reset();
        }
        viewer.ask(version, request);
        if (random.next() < 0.7f)
            std::this_thread::sleep_for(
                std::chrono::milliseconds(static_cast<int>(40 * random.next())));
    }
    const LiveStatus last = end_of(viewer, 100);
    ASSERT_EQ(last.stage, LiveStage::Done) << last.error;
    viewer.write(100, folder / "live.exr");
    EXPECT_EQ(test::read_bytes(folder / "live.exr"), file_of(request, folder / "live.exr"));
}

TEST(LiveViewer, WhatIsNotDoneIsNotSaved) {
    const test::TemporaryFolder folder;
    Viewer viewer(1, {});
    RenderRequest request = request_of();
    viewer.ask(1, request);
    end_of(viewer, 1);
    EXPECT_THROW(viewer.write(2, folder / "a.exr"), io::ArgumentError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
    EXPECT_NO_THROW(viewer.write(1, folder / "a.exr"));
}

TEST(LiveViewer, AFaultIsToldAndTheNextRequestIsSeen) {
    Viewer viewer(1, {});
    RenderRequest request = request_of();
    request.scene.camera.name = "no such camera";
    viewer.ask(1, request);
    const LiveStatus failed = end_of(viewer, 1);
    EXPECT_EQ(failed.stage, LiveStage::Failed);
    EXPECT_NE(failed.error.find("no such camera"), std::string::npos) << failed.error;
    viewer.ask(2, request_of());
    EXPECT_EQ(end_of(viewer, 2).stage, LiveStage::Done);
    EXPECT_EQ(viewer.status().error, "");
}

TEST(LiveViewer, LeavingStopsTheWork) {
    Viewer viewer(2, {});
    RenderRequest request = request_of();
    request.samples.count = 100'000'000;
    viewer.ask(1, request);
    LiveStatus now;
    while (now.stage != LiveStage::Growing) now = viewer.wait(now.number, 60s);
    viewer.leave();
    viewer.ask(2, request_of());
    EXPECT_EQ(end_of(viewer, 2).stage, LiveStage::Done);
}

TEST(LiveViewer, PagesShareTheScene) {
    Viewer first(1, {});
    first.ask(1, request_of());
    end_of(first, 1);
    Viewer second(1, first.scene());
    second.ask(1, request_of());
    end_of(second, 1);
    EXPECT_EQ(first.scene().loaded.prepared.scene.get(),
              second.scene().loaded.prepared.scene.get());
    EXPECT_EQ(first.picture()->rgba, second.picture()->rgba);
}

}  // namespace
}  // namespace petzval::apps
