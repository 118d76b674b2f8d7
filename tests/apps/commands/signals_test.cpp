// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and termination, while a scene loads and while it renders.
#include <random>

#include "tests/support/cli.h"
#include "tests/support/open_watch.h"

namespace petzval {
namespace {

class CliSignals : public CliTest, public ::testing::WithParamInterface<int> {};

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
    EXPECT_EQ(listing(),
              (std::set<std::string>{"out.exr", "out.png", "out.partial.exr", "studio.glb"}));
    const Picture partial = read_picture(path("out.partial.exr"));
    EXPECT_EQ(partial.width, 16);
    EXPECT_GT(value_at(partial, 8, 8, "B"), 0.f);
    EXPECT_GT(mean_of(partial, "A"), 0.99);
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
            continue;
        }
        EXPECT_EQ(run.exit_code, 130) << run.err;
        EXPECT_EQ(run.out + run.err, "");
        EXPECT_EQ(listing(), (std::set<std::string>{"crowd.glb", "studio.glb"}));
        return;
    }
}

INSTANTIATE_TEST_SUITE_P(Signal, CliSignals, ::testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace petzval
