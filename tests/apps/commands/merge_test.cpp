// SPDX-License-Identifier: Apache-2.0
// Renders that are divided and merged: the files are those of one run.
#include "tests/apps/commands/long_renders.h"

namespace petzval::apps {
namespace {

class Merging : public LongRenders {};

TEST_F(Merging, RangesAndCropsMergeToTheBytesOfOneRun) {
    const Words layers = {"--aov", "albedo,depth", "--view", "ACES", "--exposure", "1"};
    Words whole = layers;
    whole.insert(whole.end(),
                 {"--spp", "24", "-o", path("w.exr"), "-o", path("w.png"), "-o", path("w.jpg")});
    run(whole);
    const std::vector<Words> in_ranges = {{"--spp", "0:5"}, {"--spp", "16:24"}, {"--spp", "5:16"}};
    const std::vector<Words> in_crops = {{"--spp", "0:24", "--crop", "0,0,13,24"},
                                         {"--spp", "0:24", "--crop", "13,0,27,9"},
                                         {"--spp", "0:11", "--crop", "13,9,27,15"},
                                         {"--spp", "11:24", "--crop", "13,9,27,15"}};
    for (const auto& of : {in_ranges, in_crops}) {
        std::vector<std::string> states = parts(of, layers);
        for (int order = 0; order < 2; ++order) {
            const Finished done =
                merge(states, {"-o", path("m.exr"), "-o", path("m.png"), "-o", path("m.jpg")});
            EXPECT_EQ(done.exit_code, 0) << done.err;
            for (const char* ending : {".exr", ".png", ".jpg"})
                expect_same(std::string("w") + ending, std::string("m") + ending);
            std::reverse(states.begin(), states.end());
        }
    }
}

TEST_F(Merging, SpectraMergeWithTheirErrors) {
    const Words bins = {"--bins", "400:700:50"};
    Words whole = bins;
    whole.insert(whole.end(), {"--spp", "24", "-o", path("w.exr")});
    run(whole);
    const auto states = parts({{"--spp", "0:3"}, {"--spp", "3:20"}, {"--spp", "20:24"}}, bins);
    EXPECT_EQ(merge(states, {"-o", path("m.exr")}).exit_code, 0);
    expect_same("w.exr", "m.exr");
}

// A merged state is a state: merging in steps, as a tree, is the same.
TEST_F(Merging, MergedStatesMerge) {
    run({"--spp", "12", "-o", path("w.exr"), "-o", path("w.state")});
    parts({{"--spp", "0:4"}, {"--spp", "4:8"}, {"--spp", "8:12"}});
    ASSERT_EQ(merge({"b.state", "c.state"}, {"-o", path("bc.state")}).exit_code, 0);
    ASSERT_EQ(merge({"bc.state", "a.state"}, {"-o", path("m.exr")}).exit_code, 0);
    expect_same("w.exr", "m.exr");
    ASSERT_EQ(merge({"w.state"}, {"-o", path("again.exr")}).exit_code, 0);
    expect_same("w.exr", "again.exr");
}

TEST_F(Merging, FiguresAddUp) {
    const auto figures = [&](const std::string& name) {
        return nlohmann::json::parse(file_bytes(path(name)));
    };
    run({"--spp", "12", "-o", path("w.exr"), "--stats", path("w.json")});
    run({"--spp", "0:4", "-o", path("a.state"), "--stats", path("a.json")});
    run({"--spp", "4:12", "-o", path("b.state"), "--stats", path("b.json")});
    ASSERT_EQ(
        merge({"a.state", "b.state"}, {"-o", path("m.exr"), "--stats", path("m.json")}).exit_code,
        0);
    const auto whole = figures("w.json"), a = figures("a.json"), b = figures("b.json"),
               m = figures("m.json");
    for (const char* same : {"size_px", "samples_per_pixel", "pixel_samples", "rays",
                             "path_vertices", "exposure_ev", "bad_samples", "too_bright_samples"})
        EXPECT_EQ(m[same], whole[same]) << same;
    for (const char* sum : {"render_wall_s", "render_cpu_s", "load_s"})
        EXPECT_NEAR(m[sum].get<double>(), a[sum].get<double>() + b[sum].get<double>(), 1e-9) << sum;
}

TEST_F(Merging, WhatDoesNotBelongTogetherIsRefusedByName) {
    parts({{"--spp", "0:4"}});
    const auto refused = [&](const Words& more, const std::string& why) {
        Words all = {"--spp", "4:8", "-o", path("x.state")};
        all.insert(all.end(), more.begin(), more.end());
        run(all);
        const Finished done = merge({"a.state", "x.state"}, {"-o", path("m.exr")});
        EXPECT_EQ(done.exit_code, 1) << done.err;
        EXPECT_NE(done.err.find(path("x.state") + ": is a state of another render: " + why),
                  std::string::npos)
            << done.err;
        EXPECT_FALSE(std::filesystem::exists(path("m.exr")));
    };
    const std::string in = " in " + path("a.state") + " and ", in_x = " in " + path("x.state");
    refused({"--seed", "7"}, "seed is 0" + in + "7" + in_x);
    refused({"--method", "max-depth=3"}, "maxDepth is 16" + in + "3" + in_x);
    refused({"--method", "clamp=5"}, "clamp_nits is absent" + in + "5" + in_x);
    refused({"--fstop", "4"}, "lensRadius_m is ");
    refused({"--exposure", "1"}, "exposure is 0" + in + "1" + in_x);
    refused({"--size", "20x12"}, "frame is 40x24 px, layers none" + in + "20x12 px, layers none");
    refused({"--aov", "depth"}, "frame is 40x24 px, layers none" + in);
    refused({"--env-rotate", "10"}, "environmentRotate_deg is 0" + in + "10" + in_x);
    // Cameras of one name at one place, one of them rolled.
    TinyGltf rolled = walls();
    add_perspective(rolled, "eye", 0.8f);
    add_perspective(rolled, "eye", 0.8f);
    rolled.json["nodes"].back()["rotation"] = {0, 0, 0.7071068, 0.7071068};
    const std::string cameras = rolled.save_glb(folder_.path / "rolled.glb").string();
    for (const int i : {0, 1}) {
        const std::string range = std::to_string(4 * i) + ":" + std::to_string(4 * i + 4);
        const Words all = words({"--spp", range, "--camera", std::to_string(i), "-o",
                                 path("roll" + std::to_string(i) + ".state")},
                                cameras);
        ASSERT_EQ(run_petzval(all).exit_code, 0);
    }
    const Finished rolls = merge({"roll0.state", "roll1.state"}, {"-o", path("m.exr")});
    EXPECT_EQ(rolls.exit_code, 1);
    EXPECT_NE(rolls.err.find("pose of the camera is "), std::string::npos) << rolls.err;
    // The scene of the same name, changed.
    run({"--spp", "4:8", "-o", path("x.state")});
    TinyGltf other = studio();
    other.json["nodes"][0]["translation"] = {0, 0, -0.5};
    other.save_glb(folder_.path / "studio.glb");
    refused({}, "sceneHash is ");
}

TEST_F(Merging, GapsAndOverlapsAreRefusedByName) {
    parts({{"--spp", "0:4"}, {"--spp", "4:8"}, {"--spp", "8:12"}, {"--spp", "6:9"}});
    const Finished gap = merge({"a.state", "c.state"}, {"-o", path("m.exr")});
    EXPECT_EQ(gap.exit_code, 1);
    EXPECT_NE(gap.err.find("samples 4:8 of the pixels 0,0,40,24 are in none of them"),
              std::string::npos)
        << gap.err;
    const Finished twice = merge({"a.state", "b.state", "d.state"}, {"-o", path("m.exr")});
    EXPECT_EQ(twice.exit_code, 1);
    EXPECT_NE(twice.err.find(path("b.state") + ": has samples that are in " + path("d.state")),
              std::string::npos)
        << twice.err;
    EXPECT_EQ(merge({"a.state", "a.state"}, {"-o", path("m.exr")}).exit_code, 1);
    EXPECT_EQ(merge({"a.state"}, {"-o", path("a.state")}).exit_code, 2) << "it would be lost";
    EXPECT_FALSE(std::filesystem::exists(path("m.exr")));
}

// Numbers that JSON has not: a lens that is focused at infinity.
TEST_F(Merging, InfinityIsKept) {
    const Words far = {"--focus", "infinity"};
    Words whole = far;
    whole.insert(whole.end(), {"--spp", "8", "-o", path("w.exr")});
    run(whole);
    const auto states = parts({{"--spp", "0:3"}, {"--spp", "3:8"}}, far);
    const Finished done = merge(states, {"-o", path("m.exr")});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    expect_same("w.exr", "m.exr");
}

}  // namespace
}  // namespace petzval::apps
