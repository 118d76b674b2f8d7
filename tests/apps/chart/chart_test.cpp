// SPDX-License-Identifier: Apache-2.0
// What is made of measurements, and a small chart from the command line.
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/chart/chart_report.h"
#include "io/base/csv.h"
#include "tests/support/cli.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using nlohmann::json;

TEST(ChartPoints, QuantilesOfStudentsT) {
    // Abramowitz and Stegun 1964, table 26.10.
    EXPECT_NEAR(student_t_975(4), 2.776, 1e-3);
    EXPECT_NEAR(student_t_975(9), 2.262, 1e-3);
    EXPECT_NEAR(student_t_975(30), 2.042, 1e-3);
    EXPECT_NEAR(student_t_975(1e9), 1.960, 1e-3);
}

TEST(ChartPoints, IntervalOfFiveNumbers) {
    // Variance 2.5, standard error sqrt(2.5 / 5) = 0.7071, times 2.776.
    const Interval i = confidence_95(std::vector<double>{1, 2, 3, 4, 5});
    EXPECT_DOUBLE_EQ(i.mean, 3);
    EXPECT_NEAR(i.high - i.mean, 1.963, 1e-3);
    EXPECT_DOUBLE_EQ(i.high - i.mean, i.mean - i.low);
}

// Of made-up normal numbers 95 % of the intervals hold the mean: 1900 of 2000, within 4.9 standard
// deviations of sqrt(2000 * 0.95 * 0.05).
TEST(ChartPoints, IntervalsHoldTheMeanAsOftenAsTheySay) {
    test::Random random(7);
    int held = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> v;
        for (int i = 0; i < 5; ++i)
            v.push_back(3 + std::sqrt(-2 * std::log(1 - double(random.next()))) *
                                std::cos(2 * M_PI * double(random.next())));
        const Interval i = confidence_95(v);
        held += i.low <= 3 && 3 <= i.high;
    }
    EXPECT_TRUE(test::z_test(held, std::sqrt(2000 * 0.95 * 0.05), 1900)) << held;
}

ChartPoint point(uint32_t samples, double cpu_s, double mse) {
    ChartPoint p{samples, {}};
    for (uint32_t i = 0; i < 5; ++i)
        p.seeds.push_back({i, cpu_s * (1 + 0.01 * (i - 2.)), mse * (1 - 0.02 * (i - 2.)), mse});
    return p;
}

TEST(ChartPoints, EfficiencyIsOneOverErrorTimesTime) {
    const ChartPoint p = point(8, 2, 0.05);
    // Mean of the product: 0.1 (1 - 0.0002 * 2).
    EXPECT_NEAR(p.efficiency().mean, 1 / (0.1 * (1 - 0.0004)), 1e-9);
    EXPECT_LT(p.efficiency().low, p.efficiency().mean);
    EXPECT_GT(p.efficiency().high, p.efficiency().mean);
    ChartPoint wild = p;
    wild.seeds[0].relative_mse = 100;
    EXPECT_TRUE(std::isinf(wild.efficiency().high));
}

TEST(ChartPoints, ParetoFrontHoldsWhatNothingBeats) {
    using Points = std::vector<std::array<double, 2>>;
    const auto front = [](const Points& points) { return pareto_front(points); };
    EXPECT_EQ(front({}), std::vector<size_t>());
    EXPECT_EQ(front({{4, 1}, {1, 4}, {2, 2}, {3, 3}}), (std::vector<size_t>{1, 2, 0}));
    EXPECT_EQ(front({{1, 2}, {1, 1}}), std::vector<size_t>{1}) << "as costly, worse";
    EXPECT_EQ(front({{2, 1}, {1, 1}}), std::vector<size_t>{1}) << "as good, costlier";
    EXPECT_EQ(front({{1, 1}, {1, 1}}).size(), 2u) << "neither beats the other";
}

TEST(ChartReport, EfficiencyIsOfTheLastPointThatIsBelieved) {
    MeasuredCase of;
    of.reference.relative_mse = 0.01;
    of.methods.resize(2);
    of.methods[0].points = {point(1, 1, 0.1), point(2, 2, 0.05), point(4, 4, 0.015)};
    of.methods[1].points = {point(1, 1, 0.018)};
    const auto rows = efficiencies(of);
    EXPECT_TRUE(rows[0].believed);
    EXPECT_EQ(rows[0].point.samples, 2u) << "0.015 is less than twice 0.01";
    EXPECT_FALSE(rows[1].believed);
    EXPECT_NEAR(rows[1].to_first, 0.1 / 0.018, 1e-3);
    of.reference.relative_mse.reset();
    EXPECT_EQ(efficiencies(of)[0].point.samples, 4u) << "no floor is known";
}

class ChartCli : public CliTest {
  protected:
    [[nodiscard]] Words chart_words(const Words& more) const {
        Words all{"chart", scene_, "--threads", "2", "--quiet"};
        if (std::find(more.begin(), more.end(), "--size") == more.end())
            all.insert(all.end(), {"--size", "16x16"});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] json points(const std::string& folder) const {
        return json::parse(file_bytes(path(folder + "/points.json")));
    }
};

TEST_F(ChartCli, WritesAReport) {
    const Finished run =
        run_petzval(chart_words({"--axis", "lights", "--budget", "5s", "-o", path("report")}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out + run.err, "");
    for (const char* name :
         {"lights.svg", "lights.png", "lights-flip.svg", "lights-flip.png", "points.csv",
          "points.json", "report.html", "pictures/lights-reference.png",
          "pictures/lights-power.png", "pictures/lights-power-flip.png"})
        EXPECT_FALSE(file_bytes(path(std::string("report/") + name)).empty()) << name;

    const json all = points("report");
    ASSERT_EQ(all["cases"].size(), 1u);
    const json& of = all["cases"][0];
    EXPECT_EQ(of["axis"], "lights");
    EXPECT_GE(of["reference"]["parts"], 2);
    EXPECT_GT(of["reference"]["relative_mse"], 0.);
    ASSERT_EQ(of["methods"].size(), 3u);  // uniform, power, tree
    size_t renders = 0;
    for (const json& method : of["methods"]) {
        const json& first = method["points"].front();
        const json& last = method["points"].back();
        EXPECT_EQ(first["samples"], 1);
        EXPECT_GE(last["samples"], 16);
        // Two lamps are drawn in proportion to 1 : 10 or 1 : 1, the walls are diffuse: the
        // variance falls at least as 1 / n, in 16 times the samples below an eighth.
        EXPECT_LT(last["relative_mse"]["mean"].get<double>(),
                  first["relative_mse"]["mean"].get<double>() / 8);
        EXPECT_LT(last["flip"]["mean"], first["flip"]["mean"]);
        EXPECT_GT(last["cpu_s"]["mean"], first["cpu_s"]["mean"]);
        for (const json& p : method["points"]) {
            EXPECT_GE(p["seeds"].size(), 5u);
            EXPECT_NE(p["seeds"][0]["relative_mse"], p["seeds"][1]["relative_mse"]);
            renders += p["seeds"].size();
        }
    }
    EXPECT_EQ(read_csv_text(path("report/points.csv")).rows.size(), renders);

    const std::string page = file_bytes(path("report/report.html"));
    EXPECT_NE(page.find("data:image/png;base64,iVBOR"), std::string::npos);
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_EQ(page.find("<?xml"), std::string::npos);
    EXPECT_EQ(page.find("src=\"pictures"), std::string::npos) << "it holds all that it shows";
    EXPECT_EQ(page.find("href=\"http"), std::string::npos);
    EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST_F(ChartCli, TakesAReferenceFromAFile) {
    static_cast<void>(render_bytes({"--spp", "256", "--seed", "9"}, "reference.exr"));
    const Finished run =
        run_petzval(chart_words({"--axis", "sampler", "--budget", "5s", "--reference",
                                 path("reference.exr"), "-o", path("report")}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json of = points("report")["cases"][0];
    EXPECT_EQ(of["reference"]["by"], "reference.exr");
    EXPECT_TRUE(of["reference"]["relative_mse"].is_null());
    for (const json& p : of["methods"][0]["points"]) EXPECT_TRUE(p["believed"]);
    EXPECT_NE(file_bytes(path("report/report.html")).find("its own error is not known"),
              std::string::npos);
    EXPECT_NE(error_of(chart_words({"--reference", path("reference.exr"), "--size", "16x8", "-o",
                                    path("other")}),
                       1)
                  .find("give the same --size and --crop"),
              std::string::npos);
}

TEST_F(ChartCli, RefusesWhatItCannotDo) {
    const auto expect = [&](const Words& words, int exit_code, const std::string& part) {
        const std::string line = error_of(chart_words(words), exit_code);
        EXPECT_NE(line.find(part), std::string::npos) << line;
    };
    expect({"--axis", "colour", "-o", path("r")}, 2, "is none of camera, dispersion");
    expect({"--budget", "1s", "-o", path("r")}, 2, "--budget");
    expect({"--axis", "sampler", "--seeds", "4", "-o", path("r")}, 2, "--seeds");
    expect({"--axis", "sampler", "-o", scene_}, 1, "cannot be made a folder");
    expect({"--axis", "sampler", "-o", "/proc/none"}, 1, "/proc/none");
    expect({"--axis", "camera", "--camera", "plan", "-o", path("r")}, 2, "orthographic");
    expect({"--axis", "sampler", "--camera", "none", "-o", path("r")}, 2, "no camera \"none\"");
    expect({"--axis", "sampler", "--size", "2000x2000", "--budget", "4s", "-o", path("r")}, 2,
           "give more time or a smaller --size");
}

TEST_F(ChartCli, StopsAndSaysWhatThereIs) {
    Words words{"chart",  scene_,     "--size",   "16x16", "--axis", "sampler",
                "--axis", "spectral", "--budget", "120s",  "-o",     path("report")};
    Process run(words);
    ASSERT_TRUE(run.wait_for_stderr("spectral: "));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    run.signal(SIGINT);
    const Finished stopped = run.wait();
    EXPECT_EQ(stopped.exit_code, 130);
    EXPECT_NE(stopped.err.find("stopped: nothing was measured whole"), std::string::npos)
        << stopped.err;
    EXPECT_EQ(listing(), (std::set<std::string>{"studio.glb"}));
}

}  // namespace
}  // namespace petzval
