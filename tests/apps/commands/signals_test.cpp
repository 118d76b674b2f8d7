// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and termination, while a scene loads and while it renders.
#include <random>
#include <thread>

#include "tests/support/cli.h"

namespace petzval {
namespace {

class CliSignals : public CliTest, public ::testing::WithParamInterface<int> {};

// Whether a process waits for the two signals, as Linux tells; at start-up libraries block all for
// moments.
bool blocks_interrupts(pid_t id) {
    constexpr uint64_t kBoth = 1 << (SIGINT - 1) | 1 << (SIGTERM - 1);
    std::ifstream status("/proc/" + std::to_string(id) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigBlk:")) return std::stoull(line.substr(7), nullptr, 16) == kBoth;
    return false;
}

// Triangles by the hundred thousand, so that loading takes a while.
TinyGltf crowd() {
    std::mt19937 random(1);
    std::vector<float> xyz(9 * 300'000);
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
                                 "--progress", "bar", "--stats", path("s.json")},
                                scene_));
    ASSERT_TRUE(render.wait_for_stderr("] "));  // the first bar comes after a fifth of a second
    render.signal(GetParam());
    const Finished run = render.wait();

    EXPECT_EQ(run.exit_code, 130);
    EXPECT_NE(run.err.find("stopped: what there is, is in " + path("out.partial.exr")),
              std::string::npos);
    EXPECT_EQ(file_bytes(path("out.exr")), "the old one");
    EXPECT_EQ(file_bytes(path("out.png")), "the old one");
    EXPECT_EQ(listing(),
              (std::set<std::string>{"out.exr", "out.png", "out.partial.exr", "studio.glb"}));
    const Picture partial = read_picture(path("out.partial.exr"));
    EXPECT_EQ(partial.width, 16);
    EXPECT_GT(value_at(partial, 8, 8, "B"), 0.f);
    EXPECT_GT(mean_of(partial, "A"), 0.99);
}

TEST_P(CliSignals, WhileLoadingLeaveNothing) {
    const std::string scene = crowd().save_glb(folder_.path / "crowd.glb").string();
    Process render(render_words({"-o", path("out.exr"), "--spp", "100000000"}, scene));
    while (!blocks_interrupts(render.id())) std::this_thread::yield();
    render.signal(GetParam());
    const Finished run = render.wait();
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_EQ(run.out + run.err, "");
    EXPECT_EQ(listing(), (std::set<std::string>{"crowd.glb", "studio.glb"}));
}

INSTANTIATE_TEST_SUITE_P(Signal, CliSignals, ::testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace petzval
