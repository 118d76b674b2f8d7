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
    /// Samples that take about so long here and now.
    std::string samples_for(double wanted_s) {
        run({"--spp", "500", "-o", path("trial.exr"), "--stats", path("trial.json")});
        const auto trial = nlohmann::json::parse(file_bytes(path("trial.json")));
        std::filesystem::remove(path("trial.exr"));
        std::filesystem::remove(path("trial.json"));
        const double each_s = trial.at("render_wall_s").get<double>() / 500;
        return std::to_string(std::max(500, int(wanted_s / each_s)));
    }
    /// Waits until it renders, and as long as that; false where it has ended before.
    static bool let_render(Process& render, std::chrono::milliseconds time) {
        if (!render.wait_for_stderr("\"phase\":\"rendering\"")) return false;
        std::this_thread::sleep_for(time);
        return true;
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
    // Cameras of one name at one place, one of them rolled.
    TinyGltf rolled = walls();
    add_perspective(rolled, "eye", 0.8f);
    add_perspective(rolled, "eye", 0.8f);
    rolled.json["nodes"].back()["rotation"] = {0, 0, 0.7071068, 0.7071068};
    const std::string cameras = rolled.save_glb(folder_.path / "rolled.glb").string();
    for (const int i : {0, 1}) {
        const std::string range = std::to_string(4 * i) + ":" + std::to_string(4 * i + 4);
        const Words all = words({"--samples", range, "--camera", std::to_string(i), "-o",
                                 path("roll" + std::to_string(i) + ".state")},
                                cameras);
        ASSERT_EQ(run_petzval(all).exit_code, 0);
    }
    const Finished rolls = merge({"roll0.state", "roll1.state"}, {"-o", path("m.exr")});
    EXPECT_EQ(rolls.exit_code, 1);
    EXPECT_NE(rolls.err.find("pose of the camera is "), std::string::npos) << rolls.err;
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
    const std::string spp = samples_for(3);
    run({"--spp", spp, "-o", path("w.exr"), "-o", path("w.png")});
    Words next =
        words({"--spp", spp, "-o", path("r.exr"), "-o", path("r.png"), "--progress", "json"});
    int stops = 0;
    for (const int signal : {SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGINT}) {
        Process render(next);
        if (!let_render(render, 100ms)) break;
        render.signal(signal);
        const Finished stopped = render.wait();
        if (stopped.exit_code == 0) break;
        EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
        next = {"resume", path("r.state")};
        ++stops;
    }
    EXPECT_GE(stops, 2);
    const Finished last = run_petzval(next);
    EXPECT_EQ(last.exit_code, 0) << last.err;
    expect_same("w.exr", "r.exr");
    expect_same("w.png", "r.png");
    EXPECT_FALSE(std::filesystem::exists(path("r.state"))) << "its picture is there";
    EXPECT_FALSE(std::filesystem::exists(path("r.partial.exr")));
}

// kill -9 at random moments, PETZVAL_KILLS of them: at most what came after the last checkpoint is
// lost, nothing is half-written, and the end has the bytes of one run.
TEST_F(LongRenders, KilledAtAnyMomentGivesTheBytesOfOneRun) {
    const char* asked_kills = std::getenv("PETZVAL_KILLS");
    const int kills = asked_kills ? std::atoi(asked_kills) : 10;
    const std::string spp = samples_for(0.4 * kills);
    run({"--spp", spp, "-o", path("w.exr")});
    Words next =
        words({"--spp", spp, "-o", path("r.exr"), "--checkpoint", "0.05s", "--progress", "json"});
    std::mt19937 random(1);
    int killed = 0, kept = 0;
    uint64_t before = 0;
    for (int i = 0; i < kills; ++i) {
        Process render(next);
        if (i % 4 == 3)  // while it loads, or a state is read
            std::this_thread::sleep_for(std::chrono::milliseconds(random() % 150));
        else
            static_cast<void>(let_render(render, std::chrono::milliseconds(random() % 400)));
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
    EXPECT_GE(killed, 2);
    EXPECT_GE(kept, 1) << "checkpoints go forward";
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
    const Finished first = render.wait();
    EXPECT_EQ(first.exit_code, 130) << first.err;
    Process again({"resume", path("r.state"), "--progress", "json"});
    ASSERT_TRUE(again.wait_for_stderr("\"phase\":\"rendering\""));
    again.signal(SIGTERM);
    const Finished stopped = again.wait();
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_NE(stopped.err.find("goes on with "), std::string::npos) << stopped.err;
}

// A state that was given another name goes on under it, and is gone when its picture is there.
TEST_F(LongRenders, AStateThatWasMovedGoesOn) {
    run({"--spp", "3000", "-o", path("w.exr")});
    Process render(words({"--spp", "3000", "-o", path("r.exr"), "--progress", "json"}));
    ASSERT_TRUE(render.wait_for_stderr("\"phase\":\"rendering\""));
    render.signal(SIGTERM);
    ASSERT_EQ(render.wait().exit_code, 130);
    std::filesystem::rename(path("r.state"), path("moved.state"));
    const Finished done = run_petzval({"resume", path("moved.state")});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    expect_same("w.exr", "r.exr");
    EXPECT_FALSE(std::filesystem::exists(path("moved.state")));
    EXPECT_FALSE(std::filesystem::exists(path("r.state")));
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
    Process render(words({"--spp", "1000000", "-o", path("r.exr"), "--preview", path("p.png"),
                          "--log", path("log.txt"), "--progress", "percent"}));
    for (int i = 0; i < 6000 && !std::filesystem::exists(path("p.png")); ++i)
        std::this_thread::sleep_for(10ms);
    EXPECT_EQ(read_picture(path("p.png")).width, 40) << "while it renders";
    render.signal(SIGTERM);
    EXPECT_EQ(render.wait().exit_code, 130);
    const Finished done = run(
        {"--spp", "16", "-o", path("r.png"), "--log", path("log.txt"), "--progress", "percent"});
    EXPECT_NE(done.err.find("PROGRESS 100%\n"), std::string::npos) << done.err;
    const std::string log = file_bytes(path("log.txt"));
    EXPECT_EQ(log.substr(0, 2), "20");
    for (const char* line : {"Z stopped: petzval resume ", "Z ends with exit code 130\n",
                             "Z PROGRESS 100%\n", "Z ends with exit code 0\n"})
        EXPECT_NE(log.find(line), std::string::npos) << line << log;
}

// A limit of time that pauses interrupt: every pixel has as many samples as the files say.
TEST_F(LongRenders, ATimeLimitWithCheckpointsEndsEvenly) {
    run({"--time", "1.5s", "--checkpoint", "0.02s", "-o", path("t.state"), "-o", path("t.exr")});
    ASSERT_EQ(merge({"t.state"}, {"-o", path("m.exr")}).exit_code, 0);
    expect_same("t.exr", "m.exr");
    std::string samples;
    for (const auto& [name, value] : read_picture(path("t.exr")).metadata)
        if (name == "petzval:samples") samples = std::get<std::string>(value);
    run({"--spp", samples.substr(2), "-o", path("w.exr")});
    expect_same("w.exr", "t.exr");
}

// Numbers that JSON has not: a lens that is focused at infinity.
TEST_F(LongRenders, InfinityIsKept) {
    const Words far = {"--focus", "infinity"};
    Words whole = far;
    whole.insert(whole.end(), {"--spp", "8", "-o", path("w.exr")});
    run(whole);
    const auto states = parts({{"--samples", "0:3"}, {"--samples", "3:8"}}, far);
    const Finished done = merge(states, {"-o", path("m.exr")});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    expect_same("w.exr", "m.exr");
}

// What lies where a checkpoint would go, and is not this render's to replace.
TEST_F(LongRenders, NothingOfOthersIsReplaced) {
    text_file("r.state", "notes of mine");
    const std::string notes = error_of(words({"--spp", "1", "-o", path("r.png")}), 2);
    EXPECT_NE(notes.find("is no state of this program's"), std::string::npos) << notes;
    run({"--samples", "0:2", "-o", path("room.exr")});
    const std::string state = file_bytes(path("room.state"));
    const std::string finished = error_of(words({"--spp", "1", "-o", path("room.png")}), 2);
    EXPECT_NE(finished.find("has finished samples"), std::string::npos) << finished;
    EXPECT_TRUE(file_bytes(path("room.state")) == state);
    const Finished skipping =
        run_petzval(words({"--spp", "1", "-o", path("r.png"), "--skip-existing"}));
    EXPECT_EQ(skipping.exit_code, 2);
    EXPECT_NE(skipping.err.find("is no state of this program's"), std::string::npos)
        << skipping.err;
    run({"--spp", "1", "-o", path("r.png"), "--checkpoint", "off"});
    EXPECT_EQ(file_bytes(path("r.state")), "notes of mine");
    run({"--spp", "2", "-o", path("room.png"),
         "--skip-existing"});  // from the samples of the state
    EXPECT_TRUE(file_bytes(path("room.state")) == state);
    // Messages are added to a log, and to nothing else.
    const std::string scene = file_bytes(scene_);
    EXPECT_NE(error_of(words({"-o", path("x.png"), "--log", scene_}), 2).find("is no log"),
              std::string::npos);
    EXPECT_TRUE(file_bytes(scene_) == scene);
}

// A state holds a command: nothing of it is done before its checksum is right.
TEST_F(LongRenders, AChangedCommandIsNotRun) {
    Process render(words({"--spp", "1000000", "-o", path("r.exr"), "--progress", "json"}));
    ASSERT_TRUE(let_render(render, 50ms));
    render.signal(SIGTERM);
    ASSERT_EQ(render.wait().exit_code, 130);
    std::string state = file_bytes(path("r.state"));
    const size_t at = state.find("\"--spp\"");
    ASSERT_NE(at, std::string::npos);
    state.replace(at, 7, "\"--log\"");  // of the file 1000000, in the folder of the render
    std::ofstream(path("r.state"), std::ios::binary) << state;
    const Finished damaged = run_petzval({"resume", path("r.state")});
    EXPECT_EQ(damaged.exit_code, 1);
    EXPECT_NE(damaged.err.find("r.state: is damaged"), std::string::npos) << damaged.err;
    EXPECT_FALSE(std::filesystem::exists("1000000"));
}

// As json, also where there is nothing to resume.
TEST_F(LongRenders, ResumingTalksAsItIsAsked) {
    const Finished none = run_petzval({"resume", path("none.state"), "--progress", "json"});
    EXPECT_EQ(none.exit_code, 1);
    std::istringstream lines(none.err);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count)
        EXPECT_EQ(nlohmann::json::parse(line).at("schema"), "petzval.progress");
    EXPECT_EQ(count, 2) << none.err;  // the error, and the end
    const std::string spp = samples_for(1);
    Process render(words({"--spp", spp, "-o", path("r.exr"), "--quiet"}));
    std::this_thread::sleep_for(600ms);
    render.signal(SIGTERM);
    if (render.wait().exit_code != 130) GTEST_SKIP() << "it was over before the signal";
    const Finished quiet = run_petzval({"resume", path("r.state"), "--progress", "percent"});
    EXPECT_NE(quiet.err.find("PROGRESS 100%"), std::string::npos) << quiet.err;
}

// The words after "--" stay the last ones.
TEST_F(LongRenders, ACommandWithTwoDashesGoesOn) {
    const std::string spp = samples_for(1.5);
    run({"--spp", spp, "-o", path("w.exr")});
    Words asked = words({"--spp", spp, "-o", path("r.exr"), "--progress", "json"});
    asked.erase(asked.begin() + 1);
    asked.insert(asked.end(), {"--", scene_});
    Process render(asked);
    ASSERT_TRUE(let_render(render, 100ms));
    render.signal(SIGTERM);
    ASSERT_EQ(render.wait().exit_code, 130);
    const Finished done = run_petzval({"resume", path("r.state"), "--threads", "1"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    expect_same("w.exr", "r.exr");
}

// A limit of time that was over when it was stopped: the pass under way is finished.
TEST_F(LongRenders, ATimeLimitThatIsOverEndsEvenly) {
    Process render(words({"--size", "300x200", "--time", "1s", "-o", path("t.state"), "--progress",
                          "json", "--threads", "1"}));
    ASSERT_TRUE(let_render(render, 300ms));
    render.signal(SIGSTOP);
    std::this_thread::sleep_for(1500ms);
    render.signal(SIGTERM);
    render.signal(SIGCONT);
    if (render.wait().exit_code != 130) GTEST_SKIP() << "it was over before the signal";
    EXPECT_EQ(run_petzval({"resume", path("t.state")}).exit_code, 0);
    const Finished done = merge({"t.state"}, {"-o", path("t.exr")});
    EXPECT_EQ(done.exit_code, 0) << done.err;
}

// A render of two seconds has no time for a checkpoint: one of another stays as it was.
TEST_F(LongRenders, AnUnfinishedStateOfAnotherStaysUntilACheckpoint) {
    Process render(words({"--spp", "1000000", "-o", path("r.exr"), "--progress", "json"}));
    ASSERT_TRUE(let_render(render, 50ms));
    render.signal(SIGTERM);
    ASSERT_EQ(render.wait().exit_code, 130);
    const std::string state = file_bytes(path("r.state"));
    const Finished other = run({"--spp", "2", "-o", path("r.exr"), "--seed", "5"});
    EXPECT_NE(other.err.find("petzval resume " + path("r.state") + " would go on"),
              std::string::npos)
        << other.err;
    EXPECT_TRUE(file_bytes(path("r.state")) == state);
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
