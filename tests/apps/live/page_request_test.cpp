// SPDX-License-Identifier: Apache-2.0
// What a page may ask for, and what the rough picture leaves out of it.
#include "apps/live/page_request.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/live/rough.h"
#include "apps/request/value_error.h"
#include "tests/support/temporary_folder.h"

namespace petzval::apps {
namespace {

using nlohmann::json;
using test::TemporaryFolder;

/// Field that is refused; "" where none is.
std::string refused_field(const json& fields, const PageRules& rules) {
    try {
        (void)order_of_page(fields, rules);
        return "";
    } catch (const ValueError& error) {
        return error.option();
    }
}

class PageRequest : public ::testing::Test {
  protected:
    PageRequest() {
        std::filesystem::create_directory(scenes_);
        RenderOrder start;
        start.render.scene.scene = scenes_ / "room.glb";
        start.render.scene.camera.fstop = 2;
        start.run.threads = 3;
        rules_ = rules_of(start);
    }

    TemporaryFolder folder_;
    std::filesystem::path scenes_ = folder_.path() / "scenes";
    PageRules rules_;
};

TEST_F(PageRequest, BeginsWithWhatTheCommandLineSaid) {
    EXPECT_EQ(fields_for_page(rules_.start), (json{{"fstop", {"2"}}}));
}

TEST_F(PageRequest, ReplacesThePictureButNotTheServersPart) {
    const RenderOrder order = order_of_page({{"fov", {"40"}}, {"aov", {"depth", "uv"}}}, rules_);
    EXPECT_EQ(order.render.scene.scene, rules_.start.render.scene.scene);
    EXPECT_EQ(order.run.threads, 3);
    EXPECT_EQ(order.render.scene.camera.fov_deg, 40);
    EXPECT_EQ(order.render.layers.size(), 2u);
    EXPECT_FALSE(order.render.scene.camera.fstop.has_value());
}

TEST_F(PageRequest, FieldsOfTheServerAreRefused) {
    for (const char* name : {"output", "threads", "max-memory", "confine", "stats", "log",
                             "preview", "crop", "nonsense", ""})
        EXPECT_EQ(refused_field({{name, {"1"}}}, rules_), std::string("⟨") + name + "⟩");
}

TEST_F(PageRequest, TextsThatAFieldDoesNotTakeAreRefusedByItsName) {
    EXPECT_EQ(refused_field({{"fstop", {"wide"}}}, rules_), "⟨fstop⟩");
    EXPECT_EQ(refused_field({{"size", {"0x0"}}}, rules_), "⟨size⟩");
    EXPECT_EQ(refused_field({{"spp", {"0"}}}, rules_), "⟨spp⟩");
    EXPECT_ANY_THROW((void)order_of_page({{"fstop", "2"}}, rules_));
    EXPECT_ANY_THROW((void)order_of_page({{"fstop", {2}}}, rules_));
}

TEST_F(PageRequest, FilesLieInTheFolderOfTheSceneOrAreTheProgramsOwn) {
    test::write_text(scenes_ / "sky.hdr", "x");
    test::write_text(folder_.path() / "secret.hdr", "x");
    std::filesystem::create_symlink(folder_.path() / "secret.hdr", scenes_ / "link.hdr");
    const auto with = [&](const char* field, const std::filesystem::path& file) {
        return refused_field({{field, {file.string()}}}, rules_);
    };
    EXPECT_EQ(with("env", scenes_ / "sky.hdr"), "");
    EXPECT_EQ(with("env", "studio"), "");
    EXPECT_EQ(with("lens", "takumar-50mm-f1.2"), "");
    const auto outside = folder_.path() / "secret.hdr";
    for (const char* field :
         {"env", "lens", "aperture", "glasses", "illuminant", "response", "shutter-curve", "ocio"})
        EXPECT_EQ(with(field, outside), outside.string()) << field;
    EXPECT_NE(with("env", scenes_ / "../secret.hdr"), "");
    EXPECT_NE(with("env", scenes_ / "link.hdr"), "");

    RenderOrder start = rules_.start;
    start.render.scene.environment = outside;
    rules_ = rules_of(start);
    EXPECT_EQ(with("env", outside), "") << "the command line named it";
}

TEST(RoughPicture, LeavesOutWhatIsLearnedBeforeTheFirstSample) {
    RenderRequest request;
    request.scene.size = {640, 360};
    request.scene.camera.focus = FocusPixel{639, 359};
    request.layers = {Aov::Depth};
    request.denoise = true;
    request.samples.noise = 0.02;
    request.samples.seed = 7;
    const RenderRequest rough = rough_of(request, 3);
    EXPECT_EQ(rough.scene.size, V2i(213, 120));
    const FocusPixel pixel = std::get<FocusPixel>(*rough.scene.camera.focus);
    EXPECT_EQ(pixel.x, 212);
    EXPECT_EQ(pixel.y, 119);
    EXPECT_EQ(rough.scene.targets, TargetUse::Off);
    EXPECT_EQ(rough.samples.count, 1u);
    EXPECT_EQ(rough.samples.seed, 7u);
    EXPECT_FALSE(rough.samples.noise || rough.denoise || !rough.layers.empty());
    EXPECT_NO_THROW(check(rough));
    EXPECT_EQ(rough_of(request, 1000).scene.size, V2i(1, 1));
}

TEST(RoughPicture, IsAsFineAsTheTimeAllows) {
    const V2i size(640, 360);
    EXPECT_EQ(rough_divisor(size, 1e9, 0), 1);
    EXPECT_EQ(rough_divisor(size, 640 * 360 / kRough_s / 4, 0), 2);
    EXPECT_GT(rough_divisor(size, 640 * 360 / kRough_s / 4, 0.06), 2);
    EXPECT_EQ(rough_divisor(size, 1e6, 1), rough_divisor(size, 1e6, 1000)) << "something is seen";
    const int divisor = rough_divisor({65536, 65536}, 1e6, 0);
    EXPECT_LE(std::pow(65536. / divisor, 2), 1e6 * kRough_s);
}

TEST(RoughPicture, IsNotNeededWhereTheSamplesStay) {
    const RenderRequest request;
    RenderRequest brighter = request, more = request, other = request;
    brighter.display.exposure = ExposureRequest{false, 2};
    more.samples.count = 1000;
    other.scene.camera.fstop = 4;
    EXPECT_TRUE(keeps_samples(request, brighter));
    EXPECT_TRUE(keeps_samples(request, more));
    EXPECT_FALSE(keeps_samples(request, other));
}

}  // namespace
}  // namespace petzval::apps
