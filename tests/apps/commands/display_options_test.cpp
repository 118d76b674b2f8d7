// SPDX-License-Identifier: Apache-2.0
// --exposure, --view, --ocio and --aov: what takes them, and what is said where nothing does.
#include <cstdlib>

#include "io/image/picture_files.h"
#include "tests/support/cli.h"
#include "tests/support/ocio_config.h"

namespace petzval::apps {
namespace {

class CliDisplay : public CliTest {
  protected:
    ~CliDisplay() override {
        unsetenv("OCIO");
        unsetenv("OCIO_ACTIVE_VIEWS");
    }
    /// What a render that succeeds says of these words.
    std::string told(const Words& words) {
        Words all = render_words(words, scene_);
        all.insert(all.end(), {"--progress", "none"});
        const Finished run = run_petzval(all);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    }
    std::string config(const char* name = "aces.ocio") {
        return text_file(name, test::aces_config());
    }
    static bool has(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
};

TEST_F(CliDisplay, WhatNoOutputTakesIsSaid) {
    const std::string exr = path("a.exr"), png = path("a.png");
    EXPECT_TRUE(has(told({"-o", exr, "--exposure", "1", "--view", "ACES"}),
                    "petzval: warning: --exposure, --view: without effect, as EXR keeps the light; "
                    "add -o FILE.png, or show the EXR later by petzval image view\n"));
    EXPECT_TRUE(has(told({"-o", exr, "--ocio", config()}), "warning: --ocio: without effect"));
    EXPECT_FALSE(has(told({"-o", exr}), "without effect"));
    EXPECT_FALSE(has(told({"-o", exr, "-o", png, "--exposure", "1"}), "without effect"));
    EXPECT_FALSE(has(told({"-o", exr, "-o", png, "--aov", "depth"}), "warning"));
    for (const char* name : {"b.png", "b.jpg"})
        EXPECT_TRUE(has(error_of(render_words({"-o", path(name), "--aov", "depth"}, scene_), 2),
                        "--aov: needs an output that keeps layers: -o FILE.exr"));
}

TEST_F(CliDisplay, AConfigurationTakesThePlaceOfOurs) {
    ASSERT_FALSE(render_bytes({}, "a.exr").empty());
    const auto view = [&](const Words& more) {
        Words words = {"image", "view", path("a.exr"), "-o", path("b.png")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return io::read_picture(path("b.png")).pixels;
    };
    const auto raw = view({"--view", "raw"});
    EXPECT_NE(raw, view({}));
    EXPECT_EQ(raw, view({"--ocio", config()})) << "its default view is linear Rec. 709";
    EXPECT_EQ(raw, view({"--ocio", config(), "--view", "numbers"}));
    const auto working = view({"--ocio", config(), "--view", "Working"});
    EXPECT_NE(raw, working);
    // By the environment, which an option overrules.
    setenv("OCIO", config().c_str(), 1);
    EXPECT_EQ(working, view({"--view", "Working"}));
    setenv("OCIO", path("none.ocio").c_str(), 1);
    EXPECT_EQ(working, view({"--view", "Working", "--ocio", config()}));
    setenv("OCIO", "", 1);
    EXPECT_EQ(raw, view({"--view", "raw"}));
    setenv("OCIO_ACTIVE_VIEWS", "raw", 1);  // of a studio's configuration, not of Petzval's
    EXPECT_NE(raw, view({}));
}

TEST_F(CliDisplay, RendersShowByItAndSayWhichItIs) {
    const std::string png = path("a.png"), by = config();
    EXPECT_TRUE(has(told({"-o", png, "--ocio", by}), "petzval: display: view Rec709 of " + by));
    setenv("OCIO", by.c_str(), 1);
    EXPECT_TRUE(has(told({"-o", png, "--view", "working"}),
                    "display: view Working of " + by + ", which $OCIO names\n"));
    EXPECT_TRUE(has(error_of(render_words({"-o", png, "--view", "sRGB"}, scene_), 2),
                    "there is no view \"sRGB\"; there are Rec709, Working, Numbers, Cinema/Half"));
    const std::string none = path("none.ocio");
    setenv("OCIO", none.c_str(), 1);
    EXPECT_TRUE(has(error_of(render_words({"-o", png}, scene_), 2),
                    "$OCIO: " + none + ": cannot be used: "));
    EXPECT_FALSE(has(told({"-o", path("a.exr")}), "OCIO")) << "an EXR is not shown";
    EXPECT_TRUE(
        has(error_of({"image", "view", path("a.exr"), "-o", path("b.png"), "--ocio", ""}, 2),
            "--ocio: is empty"));
}

// Where the check failed, the file would be lost: its bytes are compared.
TEST_F(CliDisplay, FilesOfTheConfigurationAreNotOverwritten) {
    const std::string table = text_file(
        "half.spi1d", "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n 0.0\n 0.5\n}\n");
    const std::string by = text_file(
        "studio.ocio",
        test::aces_config("  aces_interchange: ACES2065-1\n",
                          "  - !<ColorSpace>\n    name: Tabled\n    to_scene_reference: "
                          "!<GroupTransform>\n      children:\n        - !<FileTransform> {src: "
                          "half.spi1d}\n"));
    const auto refused = [&](const Words& words, const std::string& file) {
        const auto before = file_bytes(file);
        const std::string why = error_of(render_words(words, scene_), 2);
        EXPECT_TRUE(file_bytes(file) == before) << file;
        return why;
    };
    const std::string png = path("a.png"), exr = path("a.exr");
    EXPECT_TRUE(has(refused({"-o", png, "--ocio", by, "--stats", table}, table),
                    "--stats would overwrite a table of the OpenColorIO configuration"));
    setenv("OCIO", by.c_str(), 1);
    EXPECT_TRUE(has(refused({"-o", exr, "--stats", table}, table), "would overwrite a table"));
    EXPECT_TRUE(has(refused({"-o", exr, "--stats", by}, by),
                    "--stats would overwrite the OpenColorIO configuration"));
}

TEST_F(CliDisplay, DisplayValuesAreNotLight) {
    const std::string exr = path("a.exr"), png = path("a.png");
    ASSERT_FALSE(told({"-o", exr, "-o", png}).empty());
    EXPECT_TRUE(has(error_of({"image", "diff", png, exr}, 1), "holds values for a display"));
    const Finished again = run_petzval({"image", "view", png, "-o", path("b.png")});
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_TRUE(has(again.err, "warning: " + png + " holds values for a display already"))
        << again.err;
    EXPECT_TRUE(has(error_of({"chart", scene_, "-o", path("report"), "--size", "16x16", "--axis",
                              "sampler", "--reference", png},
                             1),
                    "holds values for a display, not light"));
    EXPECT_TRUE(has(error_of({"image", "view", exr, "-o", path("b.png"), "--exposure", "nan"}, 2),
                    "--exposure: \"nan\""));
    EXPECT_TRUE(has(error_of({"image", "diff", exr, exr, "--fail-above", "nan"}, 2),
                    "--fail-above: \"nan\""));
}

}  // namespace
}  // namespace petzval::apps
