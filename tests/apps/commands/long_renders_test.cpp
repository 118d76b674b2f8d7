// SPDX-License-Identifier: Apache-2.0
// Renders that are stopped, killed and resumed: the files are those of one run.
#include <random>

#include "tests/apps/commands/long_renders.h"

namespace petzval::apps {
namespace {

using namespace std::chrono_literals;

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
    int killed = 0, kept = 0, in_the_instant = 0;
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
        for (const std::string& name : listing()) {
            if (name.starts_with(".petzval-")) {  // before it gets its name: io/file/atomic_file.h
                ++in_the_instant;
                std::filesystem::remove(path(name));
                continue;
            }
            EXPECT_TRUE(name == "studio.glb" || name == "w.exr" || name == "r.state") << name;
        }
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
    EXPECT_LE(in_the_instant, 1);
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
    parts({{"--spp", "0:4"}});
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
    EXPECT_EQ(io::read_picture(path("p.png")).width, 40) << "while it renders";
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
    run({"--time-limit", "1.5s", "--checkpoint", "0.02s", "-o", path("t.state"), "-o",
         path("t.exr")});
    ASSERT_EQ(merge({"t.state"}, {"-o", path("m.exr")}).exit_code, 0);
    expect_same("t.exr", "m.exr");
    std::string samples;
    for (const auto& [name, value] : io::read_picture(path("t.exr")).metadata)
        if (name == "petzval:samples") samples = std::get<std::string>(value);
    run({"--spp", samples.substr(2), "-o", path("w.exr")});
    expect_same("w.exr", "t.exr");
}

// What lies where a checkpoint would go, and is not this render's to replace.
TEST_F(LongRenders, NothingOfOthersIsReplaced) {
    text_file("r.state", "notes of mine");
    const std::string notes = error_of(words({"--spp", "1", "-o", path("r.png")}), 2);
    EXPECT_NE(notes.find("is no state of this program's"), std::string::npos) << notes;
    run({"--spp", "0:2", "-o", path("room.exr")});
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

// A state holds a request: nothing of it is done before its checksum is right.
TEST_F(LongRenders, AChangedRequestIsNotRendered) {
    Process render(words({"--spp", "1000000", "-o", path("r.exr"), "--progress", "json"}));
    ASSERT_TRUE(let_render(render, 50ms));
    render.signal(SIGTERM);
    ASSERT_EQ(render.wait().exit_code, 130);
    std::string state = file_bytes(path("r.state"));
    const size_t at = state.find("[\"spp\"");
    ASSERT_NE(at, std::string::npos);
    state.replace(at, 6, "[\"log\"");  // of the file 1000000, in the folder of the render
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
    Process render(words({"--spp", spp, "-o", path("r.exr"), "--progress", "json"}));
    ASSERT_TRUE(let_render(render, 100ms));
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
    Process render(words({"--size", "300x200", "--time-limit", "1s", "-o", path("t.state"),
                          "--progress", "json", "--threads", "1"}));
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
        const io::Picture picture = io::read_picture(path("c.exr"));
        float most = 0;
        for (size_t i = 0; i < picture.pixels.size(); i += picture.channels.size())
            for (size_t c = 0; c < 3; ++c) most = std::max(most, picture.pixels[i + c]);
        return most;
    };
    const float free = brightest({});
    EXPECT_GT(free, 0.2f);
    EXPECT_LE(brightest({"--method", "clamp=0.2"}), 0.2f * 1.000001f);
    EXPECT_EQ(brightest({"--method", "clamp=1e6"}), free);
}

}  // namespace
}  // namespace petzval::apps
