// SPDX-License-Identifier: Apache-2.0
// What tests of long renders share: a render that learns, and its states.
#pragma once

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/cli.h"

namespace petzval::apps {

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

}  // namespace petzval::apps
