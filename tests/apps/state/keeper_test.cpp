// SPDX-License-Identifier: Apache-2.0
#include "apps/state/keeper.h"

#include <gtest/gtest.h>

#include <thread>

#include "apps/setup/develop.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "tests/support/temporary_folder.h"

namespace petzval::apps {
namespace {

Film grey_film() {
    Film film({8, 4}, {0, 0, 8, 4}, {});
    FilmSample sample;
    sample.colour = Rgb(0.5f);
    sample.alpha = 1;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) film.add(x, y, 0, sample);
    return film;
}

/// As a render does: answers pauses until there were so many, or ten seconds are over.
int answer_pauses(Keeper& keeper, integrator::RenderMonitor& monitor, int wanted) {
    int pauses = 0;
    for (const double end_s = integrator::steady_s() + 10;
         pauses < wanted && integrator::steady_s() < end_s;) {
        if (monitor.pause.exchange(false)) {
            keeper.at_pause({});
            ++pauses;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return pauses;
}

TEST(Keeper, WithoutAPlanNothingPauses) {
    integrator::RenderMonitor monitor;
    Keeper keeper({}, monitor);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_FALSE(monitor.pause);
    keeper.at_pause({});
}

TEST(Keeper, WritesCheckpointsAgainAndAgain) {
    integrator::RenderMonitor monitor;
    int written = 0;
    KeeperPlan plan;
    plan.checkpoint_s = 0.01;
    plan.write_checkpoint = [&](const integrator::PathStats&) { ++written; };
    Keeper keeper(plan, monitor);
    EXPECT_EQ(answer_pauses(keeper, monitor, 5), 5);
    EXPECT_GE(written, 4) << "a pause may come before its time";
}

// A disk that is full for a while: it is told once, tried again, and nothing is thrown.
TEST(Keeper, GoesOnWhereACheckpointCannotBeWritten) {
    integrator::RenderMonitor monitor;
    int tries = 0;
    std::vector<std::string> said;
    KeeperPlan plan;
    plan.checkpoint_s = 0.01;
    plan.write_checkpoint = [&](const integrator::PathStats&) {
        ++tries;
        throw io::OutputError("a.state", "", "cannot be written: no space");
    };
    plan.notice = [&](const std::string& text) { said.push_back(text); };
    Keeper keeper(plan, monitor);
    EXPECT_EQ(answer_pauses(keeper, monitor, 5), 5);
    EXPECT_GE(tries, 4);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_EQ(said[0], "warning: a.state: cannot be written: no space; it is tried again");
}

TEST(Keeper, WritesAPreviewOfWhatThereIs) {
    const test::TemporaryFolder folder;
    integrator::RenderMonitor monitor;
    const Film film = grey_film();
    KeeperPlan plan;
    plan.preview = folder / "now.png";
    plan.look = [&] { return colours_of(film, 4); };
    {
        Keeper keeper(plan, monitor);
        EXPECT_EQ(answer_pauses(keeper, monitor, 1), 1);
        for (int i = 0; i < 1000 && !std::filesystem::exists(*plan.preview); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    const io::Picture now = io::read_picture(*plan.preview);
    EXPECT_EQ(now.width, 8);
    EXPECT_EQ(now.height, 4);
    EXPECT_NEAR(now.pixels[0], 0.7354f, 0.003f);  // 0.5 by IEC 61966-2-1
}

}  // namespace
}  // namespace petzval::apps
