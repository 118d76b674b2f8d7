// SPDX-License-Identifier: Apache-2.0
// Signals that end a program, while a scene loads, while it renders, and while files are written.
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "io/image/picture_files.h"
#include "tests/support/cli.h"
#include "tests/support/open_watch.h"

namespace petzval::apps {
namespace {

class CliSignals : public CliTest, public ::testing::WithParamInterface<int> {
  protected:
    static std::string name_of(int signal) { return std::string("SIG") + sigabbrev_np(signal); }
};

class CliSignalPairs : public CliTest {
  protected:
    /// Words of a render without end, whose statistics wait for somebody to read them.
    Words endless(const Words& more) {
        mkfifo(path("pipe").c_str(), 0600);
        Words words = {"-o",         path("out.exr"), "--spp",   "100000000",
                       "--progress", "json",          "--stats", path("pipe")};
        words.insert(words.end(), more.begin(), more.end());
        return render_words(words, scene_);
    }
    /// What is written to the pipe; empty where nobody has for a minute, as the program has gone.
    [[nodiscard]] std::string from_pipe() const {
        const int pipe = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
        std::string all;
        pollfd wanted{pipe, POLLIN, 0};
        while (::poll(&wanted, 1, 60'000) == 1) {
            std::array<char, 4096> part{};
            const ssize_t count = ::read(pipe, part.data(), part.size());
            if (count <= 0) break;
            all.append(part.data(), size_t(count));
        }
        ::close(pipe);
        return all;
    }
};

// Triangles that have nothing in common, so that loading takes a while.
TinyGltf crowd(size_t triangles) {
    std::mt19937 random(1);
    std::vector<float> xyz(9 * triangles);
    for (float& v : xyz) v = float(random() % 10007) / 100.f;
    TinyGltf file;
    nlohmann::json primitive;
    primitive["attributes"]["POSITION"] = file.add_positions(xyz);
    file.add_root({{"mesh", file.add_mesh(primitive)}});
    return file;
}

TEST_P(CliSignals, StopARenderAndKeepWhatThereIs) {
    std::ofstream(path("out.exr")) << "the old one";
    std::ofstream(path("out.png")) << "the old one";
    Process render(render_words({"-o", path("out.exr"), "-o", path("out.png"), "--spp", "100000000",
                                 "--progress", "json", "--stats", path("s.json")},
                                scene_));
    ASSERT_TRUE(wait_for_samples(render, 16 * 16));  // the first pass is over
    render.signal(GetParam());
    const Finished run = render.wait();

    EXPECT_EQ(run.exit_code, 130);
    EXPECT_NE(run.err.find("stopped: what there is, is in " + path("out.partial.exr")),
              std::string::npos);
    EXPECT_EQ(file_bytes(path("out.exr")), "the old one");
    EXPECT_EQ(file_bytes(path("out.png")), "the old one");
    EXPECT_NE(run.err.find("petzval resume " + path("out.state") + " goes on"), std::string::npos);
    EXPECT_EQ(listing(), (std::set<std::string>{"out.exr", "out.png", "out.partial.exr",
                                                "out.state", "s.json", "studio.glb"}));
    const io::Picture partial = io::read_picture(path("out.partial.exr"));
    EXPECT_EQ(partial.width, 16);
    EXPECT_GT(value_at(partial, 8, 8, "B"), 0.f);
    EXPECT_GT(mean_of(partial, "A"), 0.99);
    const auto stats = nlohmann::json::parse(file_bytes(path("s.json")));
    EXPECT_EQ(stats.at("stopped_by"), name_of(GetParam()));
    EXPECT_GE(stats.at("samples_per_pixel"), 1);
    EXPECT_EQ(stats.at("outputs"),
              nlohmann::json::array(
                  {{{"file", path("out.state")}, {"error", nullptr}, {"rescue", nullptr}},
                   {{"file", path("out.partial.exr")}, {"error", nullptr}, {"rescue", nullptr}}}));
}

// The first notice is of a scene that is loaded. Where it is there before the signal, a larger
// scene is tried.
TEST_P(CliSignals, WhileLoadingLeaveNothing) {
    for (size_t triangles = 300'000;; triangles *= 2) {
        const std::string scene = crowd(triangles).save_glb(folder_.path / "crowd.glb").string();
        const test::OpenWatch opened(scene);
        Process render(render_words({"-o", path("out.exr"), "--spp", "100000000"}, scene));
        ASSERT_TRUE(opened.wait());
        render.signal(GetParam());
        const Finished run = render.wait();
        if (run.err.find("nothing lights this scene") != std::string::npos &&
            triangles < 4'000'000) {
            std::filesystem::remove(path("out.partial.exr"));
            std::filesystem::remove(path("out.state"));
            continue;
        }
        EXPECT_EQ(run.exit_code, 130) << run.err;
        EXPECT_EQ(run.out + run.err, "");
        EXPECT_EQ(listing(), (std::set<std::string>{"crowd.glb", "studio.glb"}));
        return;
    }
}

INSTANTIATE_TEST_SUITE_P(Signal, CliSignals,
                         ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2));

// timeout(1) sends its signal twice, systemd SIGHUP after SIGTERM, a limit of CPU time SIGXCPU each
// second: none of that is somebody who waits no longer.
TEST_F(CliSignalPairs, OfOneWishCountOnce) {
    Process render(endless({}));
    ASSERT_TRUE(wait_for_samples(render, 16 * 16));
    render.signal(SIGSTOP);  // what comes now comes at once
    render.signal(SIGTERM);
    render.signal(SIGHUP);
    render.signal(SIGCONT);
    ASSERT_TRUE(render.wait_for_stderr("stopped: what there is, is in"));
    for (int i = 0; i < 5; ++i) {
        render.signal(SIGXCPU);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const std::string stats = from_pipe();
    EXPECT_EQ(render.wait().exit_code, 130);
    EXPECT_TRUE(nlohmann::json::parse(stats, nullptr, false).contains("stopped_by"));
}

TEST_F(CliSignalPairs, TheSecondEndsAtOnce) {
    Process render(endless({}));
    ASSERT_TRUE(wait_for_samples(render, 16 * 16));
    render.signal(SIGINT);
    ASSERT_TRUE(render.wait_for_stderr("stopped: what there is, is in"));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    render.signal(SIGTERM);  // the statistics have no reader: it would wait for ever
    const Finished run = render.wait();
    EXPECT_EQ(run.exit_code, 130);
    EXPECT_FALSE(run.timed_out);
}

TEST_F(CliSignalPairs, ThoseIgnoredBeforeStayIgnored) {
    ProcessOptions options;
    options.ignored_signals = {SIGHUP, SIGINT};  // nohup, and a job in the background of a script
    Process render(render_words({"-o", path("out.exr"), "--spp", "100000000", "--progress", "json",
                                 "--stats", path("s.json")},
                                scene_),
                   options);
    ASSERT_TRUE(wait_for_samples(render, 16 * 16));
    render.signal(SIGHUP);
    render.signal(SIGINT);
    ASSERT_TRUE(wait_for_samples(render, 4 * 16 * 16)) << "it goes on";
    render.signal(SIGTERM);
    EXPECT_EQ(render.wait().exit_code, 130);
    EXPECT_EQ(nlohmann::json::parse(file_bytes(path("s.json"))).at("stopped_by"), "SIGTERM");
}

TEST_F(CliSignalPairs, AReaderThatHasGoneStopsNothing) {
    const auto exit_code_before_true = [&](const Words& words) {
        std::string command = "exec 3>&1; { \"$0\"";
        for (const std::string& word : words) command += " '" + word + "'";
        command += "; echo $? >&3; } 2>&1 | true";
        const Finished run = Process({"-c", command, PETZVAL_PROGRAM}, {}, "/bin/sh").wait();
        EXPECT_EQ(run.err, "");
        return run.out;
    };
    EXPECT_EQ(
        exit_code_before_true(render_words({"-o", path("out.exr"), "--progress", "lines"}, scene_)),
        "0\n");
    EXPECT_EQ(io::read_picture(path("out.exr")).width, 16);
    EXPECT_EQ(exit_code_before_true({"lens", "list"}), "0\n");
    EXPECT_EQ(exit_code_before_true({"image", "diff", path("none.exr"), path("none.exr")}), "1\n");
}

}  // namespace
}  // namespace petzval::apps
