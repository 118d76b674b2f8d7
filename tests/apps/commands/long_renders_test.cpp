// SPDX-License-Identifier: Apache-2.0
// Renders that are divided, merged, killed and resumed: the files are those of one run.
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/support/cli.h"

namespace petzval {
namespace {

using namespace std::chrono_literals;

class LongRenders : public CliTest {
  protected:
    // A lens and light at infinity beside lamps: what pilots learn belongs to it.
    const Words what_ = {"--fstop", "2", "--focus", "1.2", "--env", "studio", "--size", "40x24"};

    [[nodiscard]] Words words(const Words& more, const std::string& scene = "") const {
        Words all = {"render", scene.empty() ? scene_ : scene};
        all.insert(all.end(), what_.begin(), what_.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Finished run(const Words& more) {
        const Finished done = run_petzval(words(more));
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done;
    }
    Finished merge(const std::vector<std::string>& states, const Words& more) {
        Words all = {"merge"};
        for (const std::string& state : states) all.push_back(path(state));
        all.insert(all.end(), more.begin(), more.end());
        return run_petzval(all);
    }
    void expect_same(const std::string& a, const std::string& b) {
        EXPECT_TRUE(file_bytes(path(a)) == file_bytes(path(b))) << a << ' ' << b;
        EXPECT_FALSE(file_bytes(path(a)).empty());
    }
    /// States of parts: a.state, b.state ...
    std::vector<std::string> parts(const std::vector<Words>& of, const Words& more = {}) {
        std::vector<std::string> out;
        for (const Words& part : of) {
            out.push_back(std::string(1, char('a' + out.size())) + ".state");
            Words all = part;
            all.insert(all.end(), {"-o", path(out.back())});
            all.insert(all.end(), more.begin(), more.end());
            run(all);
        }
        return out;
    }
};

TEST_F(LongRenders, RangesAndCropsMergeToTheBytesOfOneRun) {
    const Words layers = {"--aov", "albedo,depth", "--view", "ACES", "--exposure", "1"};
    Words whole = layers;
    whole.insert(whole.end(),
                 {"--spp", "24", "-o", path("w.exr"), "-o", path("w.png"), "-o", path("w.jpg")});
    run(whole);
    const std::vector<Words> in_ranges = {
        {"--samples", "0:5"}, {"--samples", "16:24"}, {"--samples", "5:16"}};
    const std::vector<Words> in_crops = {{"--samples", "0:24", "--crop", "0,0,13,24"},
                                         {"--samples", "0:24", "--crop", "13,0,27,9"},
                                         {"--samples", "0:11", "--crop", "13,9,27,15"},
                                         {"--samples", "11:24", "--crop", "13,9,27,15"}};
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

TEST_F(LongRenders, SpectraMergeWithTheirErrors) {
    const Words bins = {"--bins", "400:700:50"};
    Words whole = bins;
    whole.insert(whole.end(), {"--spp", "24", "-o", path("w.exr")});
    run(whole);
    const auto states =
        parts({{"--samples", "0:3"}, {"--samples", "3:20"}, {"--samples", "20:24"}}, bins);
    EXPECT_EQ(merge(states, {"-o", path("m.exr")}).exit_code, 0);
    expect_same("w.exr", "m.exr");
}

// A merged state is a state: merging in steps, as a tree, is the same.
TEST_F(LongRenders, MergedStatesMerge) {
    run({"--spp", "12", "-o", path("w.exr"), "-o", path("w.state")});
    parts({{"--samples", "0:4"}, {"--samples", "4:8"}, {"--samples", "8:12"}});
    ASSERT_EQ(merge({"b.state", "c.state"}, {"-o", path("bc.state")}).exit_code, 0);
    ASSERT_EQ(merge({"bc.state", "a.state"}, {"-o", path("m.exr")}).exit_code, 0);
    expect_same("w.exr", "m.exr");
    ASSERT_EQ(merge({"w.state"}, {"-o", path("again.exr")}).exit_code, 0);
    expect_same("w.exr", "again.exr");
}

TEST_F(LongRenders, FiguresAddUp) {
    const auto figures = [&](const std::string& name) {
        return nlohmann::json::parse(file_bytes(path(name)));
    };
    run({"--spp", "12", "-o", path("w.exr"), "--stats", path("w.json")});
    run({"--samples", "0:4", "-o", path("a.state"), "--stats", path("a.json")});
    run({"--samples", "4:12", "-o", path("b.state"), "--stats", path("b.json")});
    ASSERT_EQ(
        merge({"a.state", "b.state"}, {"-o", path("m.exr"), "--stats", path("m.json")}).exit_code,
        0);
    const auto whole = figures("w.json"), a = figures("a.json"), b = figures("b.json"),
               m = figures("m.json");
    for (const char* same : {"size_px", "samples_per_pixel", "pixel_samples", "rays",
                             "path_vertices", "exposure_ev", "bad_samples"})
        EXPECT_EQ(m[same], whole[same]) << same;
    for (const char* sum : {"render_wall_s", "render_cpu_s", "load_s"})
        EXPECT_NEAR(m[sum].get<double>(), a[sum].get<double>() + b[sum].get<double>(), 1e-9) << sum;
}

TEST_F(LongRenders, WhatDoesNotBelongTogetherIsRefusedByName) {
    parts({{"--samples", "0:4"}});
    const auto refused = [&](const Words& more, const std::string& why) {
        Words all = {"--samples", "4:8", "-o", path("x.state")};
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
    refused({"--max-depth", "3"}, "maxDepth is 16" + in + "3" + in_x);
    refused({"--clamp", "5"}, "clamp_nits is absent" + in + "5" + in_x);
    refused({"--fstop", "4"}, "lensRadius_m is ");
    refused({"--exposure", "1"}, "exposure is 0" + in + "1" + in_x);
    refused({"--size", "20x12"}, "frame is 40x24 px, layers none" + in + "20x12 px, layers none");
    refused({"--aov", "depth"}, "frame is 40x24 px, layers none" + in);
    refused({"--env-rotate", "10"}, "environmentRotate_deg is 0" + in + "10" + in_x);
    // The scene of the same name, changed.
    run({"--samples", "4:8", "-o", path("x.state")});
    TinyGltf other = studio();
    other.json["nodes"][0]["translation"] = {0, 0, -0.5};
    other.save_glb(folder_.path / "studio.glb");
    refused({}, "sceneHash is ");
}

TEST_F(LongRenders, GapsAndOverlapsAreRefusedByName) {
    parts(
        {{"--samples", "0:4"}, {"--samples", "4:8"}, {"--samples", "8:12"}, {"--samples", "6:9"}});
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

// One picture, stopped by every signal in turn, in the middle of its passes.
TEST_F(LongRenders, StoppedAgainAndAgainGivesTheBytesOfOneRun) {
    const Words asked = {"--spp", "3000",        "-o",         path("r.exr"),
                         "-o",    path("r.png"), "--progress", "json"};
    run({"--spp", "3000", "-o", path("w.exr"), "-o", path("w.png")});
    Words next = words(asked);
    int stops = 0;
    for (const int signal : {SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGINT}) {
        Process render(next);
        if (!render.wait_for_stderr("\"phase\":\"rendering\"")) break;
        std::this_thread::sleep_for(100ms);
        render.signal(signal);
        const Finished stopped = render.wait();
        if (stopped.exit_code == 0) break;
        EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
        next = {"resume", path("r.state")};
        ++stops;
    }
    EXPECT_GE(stops, 3);
    const Finished last = run_petzval(next);
    EXPECT_EQ(last.exit_code, 0) << last.err;
    expect_same("w.exr", "r.exr");
    expect_same("w.png", "r.png");
    EXPECT_FALSE(std::filesystem::exists(path("r.state"))) << "its picture is there";
    EXPECT_FALSE(std::filesystem::exists(path("r.partial.exr")));
}

// kill -9 at random moments, a hundred times where KILLS says so: at most what came after the last
// checkpoint is lost, nothing is half-written, and the end has the bytes of one run.
TEST_F(LongRenders, KilledAtAnyMomentGivesTheBytesOfOneRun) {
    const char* asked_kills = std::getenv("PETZVAL_KILLS");
    const int kills = asked_kills ? std::atoi(asked_kills) : 10;
    const std::string spp = std::to_string(600 * kills);
    run({"--spp", spp, "-o", path("w.exr")});
    Words next = words({"--spp", spp, "-o", path("r.exr"), "--checkpoint", "0.05s"});
    std::mt19937 random(1);
    int killed = 0, kept = 0;
    uint64_t before = 0;
    for (int i = 0; i < kills; ++i) {
        Process render(next);
        std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 400));
        render.signal(SIGKILL);
        if (render.wait().exit_code == 0) break;
        ++killed;
        for (const std::string& name : listing())
            EXPECT_TRUE(name == "studio.glb" || name == "w.exr" || name == "r.state") << name;
        if (!std::filesystem::exists(path("r.state"))) continue;
        next = {"resume", path("r.state")};
        const Finished looked = merge({"r.state"}, {"-o", path("m.exr")});
        EXPECT_EQ(looked.exit_code, 1);
        const size_t at = looked.err.find("it has ");
        ASSERT_NE(at, std::string::npos) << looked.err;
        const auto share = std::stoull(looked.err.substr(at + 7));
        EXPECT_GE(share, before) << "what was kept stays";
        kept += share > before;
        before = share;
    }
    EXPECT_GE(killed, kills / 2);
    EXPECT_GE(kept, 2) << "checkpoints go forward";
    const Finished last = run_petzval(next);
    EXPECT_EQ(last.exit_code, 0) << last.err;
    expect_same("w.exr", "r.exr");
}

TEST_F(LongRenders, ResumingElsewhereMeansTheSameFiles) {
    ProcessOptions in_folder;
    in_folder.folder = folder_.path;
    Words relative = words({"--spp", "100000", "-o", "r.exr", "--progress", "json"}, "studio.glb");
    Process render(relative, in_folder);
    ASSERT_TRUE(render.wait_for_stderr("\"phase\":\"rendering\""));
    render.signal(SIGTERM);
    EXPECT_EQ(render.wait().exit_code, 130);
    Process again({"resume", path("r.state"), "--progress", "json"});
    ASSERT_TRUE(again.wait_for_stderr("\"phase\":\"rendering\""));
    again.signal(SIGTERM);
    const Finished stopped = again.wait();
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_NE(stopped.err.find("goes on with "), std::string::npos) << stopped.err;
}

// What the samples follow from has changed since: it says what, and leaves the state as it was.
TEST_F(LongRenders, AStateOfSomethingElseIsNotResumed) {
    Process render(words({"--spp", "1000000", "-o", path("r.exr"), "--progress", "json"}));
    ASSERT_TRUE(render.wait_for_stderr("\"phase\":\"rendering\""));
    render.signal(SIGTERM);
    EXPECT_EQ(render.wait().exit_code, 130);
    const std::string state = file_bytes(path("r.state"));
    TinyGltf other = studio();
    other.json["nodes"][0]["translation"] = {0, 0, -0.5};
    other.save_glb(folder_.path / "studio.glb");
    const Finished refused = run_petzval({"resume", path("r.state")});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("something has changed: sceneHash is "), std::string::npos)
        << refused.err;
    EXPECT_TRUE(file_bytes(path("r.state")) == state);
    studio().save_glb(folder_.path / "studio.glb");
    std::string flipped = state;
    flipped[flipped.size() / 2] ^= 1;
    std::ofstream(path("r.state"), std::ios::binary) << flipped;
    const Finished damaged = run_petzval({"resume", path("r.state")});
    EXPECT_EQ(damaged.exit_code, 1);
    EXPECT_NE(damaged.err.find("r.state: is damaged"), std::string::npos) << damaged.err;
}

TEST_F(LongRenders, ACompleteStateHasNothingToResume) {
    parts({{"--samples", "0:4"}});
    const Finished done = run_petzval({"resume", path("a.state")});
    EXPECT_EQ(done.exit_code, 0);
    EXPECT_NE(done.err.find("a.state is complete: there is nothing to render"), std::string::npos);
}

// The disk fills up during checkpoints: the render says so once, goes on, and writes its picture,
// which is smaller than its state.
TEST_F(LongRenders, AFullDiskDuringACheckpointEndsNothing) {
    ProcessOptions full;
    full.file_size_limit_bytes = 60'000;
    const Words asked = {"--spp", "4000", "-o", path("r.png"), "--checkpoint", "0.05s"};
    const Finished done = run_petzval(words(asked), full);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const size_t told =
        done.err.find("r.state: cannot be written: File too large; it is tried again");
    EXPECT_NE(told, std::string::npos) << done.err;
    EXPECT_EQ(done.err.find("is tried again", told + 80), std::string::npos) << done.err;
    EXPECT_EQ(listing(), (std::set<std::string>{"r.png", "studio.glb"}));
}

// Two at once write the same files: those that are there at the end are whole.
TEST_F(LongRenders, TwoWithOneOutputAreBothWhole) {
    run({"--spp", "400", "-o", path("w.exr")});
    const Words asked = words({"--spp", "400", "-o", path("r.exr"), "--checkpoint", "0.02s"});
    Process a(asked), b(asked);
    EXPECT_EQ(a.wait().exit_code, 0);
    EXPECT_EQ(b.wait().exit_code, 0);
    expect_same("w.exr", "r.exr");
}

TEST_F(LongRenders, LooksOn) {
    const Finished done = run({"--spp", "2000", "-o", path("r.exr"), "--preview", path("p.png"),
                               "--log", path("log.txt"), "--progress", "percent"});
    EXPECT_NE(done.err.find("PROGRESS 100%\n"), std::string::npos) << done.err;
    const std::string log = file_bytes(path("log.txt"));
    EXPECT_EQ(log.substr(0, 2), "20");
    EXPECT_NE(log.find("Z PROGRESS 100%\n"), std::string::npos) << log;
    EXPECT_NE(log.find("Z ends with exit code 0\n"), std::string::npos) << log;
    EXPECT_EQ(read_picture(path("p.png")).width, 40);
}

// A sample that is brighter keeps its colour; the file says that it was clamped.
TEST_F(LongRenders, ClampTakesWhatIsBrighter) {
    const auto brightest = [&](const Words& more) {
        Words all = {"--spp", "1", "-o", path("c.exr")};
        all.insert(all.end(), more.begin(), more.end());
        run(all);
        const Picture picture = read_picture(path("c.exr"));
        float most = 0;
        for (size_t i = 0; i < picture.pixels.size(); i += picture.channels.size())
            for (size_t c = 0; c < 3; ++c) most = std::max(most, picture.pixels[i + c]);
        return most;
    };
    const float free = brightest({});
    EXPECT_GT(free, 0.2f);
    EXPECT_LE(brightest({"--clamp", "0.2"}), 0.2f * 1.000001f);
    EXPECT_EQ(brightest({"--clamp", "1e6"}), free);
}

}  // namespace
}  // namespace petzval
