// SPDX-License-Identifier: Apache-2.0
// Small charts: on a stepped clock, and from the command line.
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "apps/chart/chart.h"
#include "io/file/csv.h"
#include "io/image/symmetric_mse.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using nlohmann::json;

/// Runs charts on a machine of known speed: only samples take time, each equally long.
class ChartRun : public CliTest {
  protected:
    static constexpr int kPixels = 16 * 16;

    /// 5 s for each axis, of which one sample of every pixel takes 5 ms.
    [[nodiscard]] ChartRequest request(const std::vector<ChartAxis>& axes) const {
        ChartRequest r;
        r.subject.request.scene = scene_;
        r.subject.request.size = r.frame.size = {16, 16};
        r.frame.crop = {0, 0, 16, 16};
        r.subject.folder = folder_.path / "report";
        r.axes = axes;
        r.budget_s = 5 * double(axes.size());
        return r;
    }
    void take(double seconds_a_sample) {
        before_s_ = elapsed_s();
        samples_before_ = monitor_.pixel_samples_done;
        sample_s_ = seconds_a_sample / kPixels;
    }
    [[nodiscard]] double elapsed_s() const {
        return before_s_ + sample_s_ * double(monitor_.pixel_samples_done - samples_before_);
    }
    ChartOutcome run(const ChartRequest& request) {
        const ChartClock clock{[this] {
                                   if (elapsed_s() >= stop_at_s_) monitor_.stop = true;
                                   return 1e6 + elapsed_s();  // a clock starts anywhere
                               },
                               [this] { return 3 * elapsed_s(); }};
        return run_chart(
            request, executor_, monitor_, [](const std::string&) {},
            [this](const MeasuredCase& of) {
                cases_.push_back(of);
                if (after_first_case) after_first_case();
            },
            clock);
    }
    /// What it says of a request that it refuses, once nothing is left in the folder.
    std::string refused(const ChartRequest& r) {
        try {
            static_cast<void>(run(r));
        } catch (const io::ArgumentError& error) {
            EXPECT_EQ(listing(), (std::set<std::string>{"studio.glb"}));
            return error.what();
        }
        return "accepted";
    }
    [[nodiscard]] json points() const {
        return json::parse(file_bytes(path("report/points.json")));
    }

    double stop_at_s_ = HUGE_VAL;
    std::function<void()> after_first_case;
    std::vector<MeasuredCase> cases_;

  private:
    integrator::TbbExecutor executor_{2};
    integrator::RenderMonitor monitor_;
    double sample_s_ = 5e-3 / kPixels, before_s_ = 0;
    uint64_t samples_before_ = 0;
};

TEST_F(ChartRun, WritesAReport) {
    const ChartOutcome outcome = run(request({ChartAxis::Lights}));
    EXPECT_EQ(outcome.measured, 1u);
    EXPECT_FALSE(outcome.stopped);
    for (const char* name :
         {"lights.svg", "lights.png", "lights-relative.svg", "lights-relative.png",
          "lights-flip.svg", "lights-flip.png", "points.csv", "points.json", "report.html",
          "pictures/lights-reference.png", "pictures/lights-power.png",
          "pictures/lights-power-flip.png"})
        EXPECT_FALSE(file_bytes(path(std::string("report/") + name)).empty()) << name;

    const json all = points();
    ASSERT_EQ(all["cases"].size(), 1u);
    const json& of = all["cases"][0];
    EXPECT_EQ(of["axis"], "lights");
    EXPECT_EQ(of["reference"]["parts"], kReferenceReplicates);
    for (const char* error : {"symmetric_mse", "relative_mse", "flip_at_most"})
        EXPECT_GT(of["reference"][error], 0.) << error;
    ASSERT_EQ(of["methods"].size(), 3u);  // uniform, power, tree
    size_t renders = 0;
    for (const json& method : of["methods"]) {
        const json& first = method["points"].front();
        const json& last = method["points"].back();
        uint32_t samples = 1;
        for (const json& p : method["points"]) {
            EXPECT_EQ(p["samples"], samples);
            // Costs are those of the other clock, and of nothing but this render's samples.
            EXPECT_NEAR(p["cpu_s"]["mean"], 3 * 5e-3 * samples, 1e-9);
            EXPECT_EQ(p["seeds"].size(), kChartSeeds);
            for (const char* error : {"symmetric_mse", "relative_mse", "flip"})
                EXPECT_NE(p["seeds"][0][error], p["seeds"][1][error]) << error;
            EXPECT_LE(p["symmetric_mse"]["mean"], io::kMostSymmetricMse);
            renders += p["seeds"].size();
            samples *= 2;
        }
        EXPECT_GE(last["samples"], 16);
        // Two lamps are drawn in proportion to 1 : 10 or 1 : 1, the walls are diffuse: the
        // variance falls at least as 1 / n, in 16 times the samples below an eighth.
        for (const char* error : {"symmetric_mse", "relative_mse"})
            EXPECT_LT(last[error]["mean"].get<double>(), first[error]["mean"].get<double>() / 8)
                << error;
        EXPECT_LT(last["flip"]["mean"], first["flip"]["mean"]);
    }
    const std::string csv = file_bytes(path("report/points.csv"));
    EXPECT_TRUE(csv.starts_with(
        "axis,case,method,samples,seed,cpu_s,symmetric_mse,relative_mse,flip,believed\n"));
    const json& first_render = of["methods"][0]["points"][0]["seeds"][0];
    const io::CsvText table = io::read_csv_text(path("report/points.csv"));
    EXPECT_EQ(table.rows.size(), renders);
    for (size_t column = 5; column < 9; ++column) {  // cpu_s, and the errors
        const double value = first_render[table.names[column]];
        EXPECT_NEAR(std::stod(table.rows[0][column]), value, 1e-6 * value) << table.names[column];
    }
    for (const auto& [file, label] : {std::pair{"lights.svg", ">symmetric MSE<"},
                                      {"lights-relative.svg", ">relative MSE<"},
                                      {"lights-flip.svg", ">FLIP<"}})
        EXPECT_NE(file_bytes(path(std::string("report/") + file)).find(label), std::string::npos)
            << file;

    const std::string page = file_bytes(path("report/report.html"));
    EXPECT_NE(page.find("data:image/png;base64,iVBOR"), std::string::npos);
    for (const char* label : {">symmetric MSE</text>", ">relative MSE</text>", ">FLIP</text>"})
        EXPECT_NE(page.find(label), std::string::npos) << label;
    EXPECT_EQ(page.find("<?xml"), std::string::npos);
    EXPECT_EQ(page.find("src=\"pictures"), std::string::npos) << "it holds all that it shows";
    EXPECT_EQ(page.find("href=\"http"), std::string::npos);
    EXPECT_TRUE(page.ends_with("</html>\n"));
}

// A tenth of the time is for plots and pictures. Samples double while the next number fits, so that
// less than half of the rest is left over.
TEST_F(ChartRun, UsesTheTimeThatItHasAndNoMore) {
    for (const double budget_s : {4., 5., 6., 7.}) {
        const double start_s = elapsed_s();
        ChartRequest r = request({ChartAxis::Lights});
        r.budget_s = budget_s;
        EXPECT_EQ(run(r).measured, 1u);
        const MeasuredCase& of = cases_.back();
        EXPECT_NEAR(of.wall_s, elapsed_s() - start_s, 1e-6);
        EXPECT_LE(of.wall_s, 0.9 * budget_s);
        EXPECT_GE(of.wall_s, 0.45 * budget_s);
        const double reference_s = of.reference.samples * kReferenceReplicates * 5e-3;
        EXPECT_NEAR(of.reference.cpu_s, 3 * reference_s, 1e-9);
        EXPECT_GE(reference_s, 0.2 * budget_s);
        EXPECT_LE(reference_s, 0.4 * budget_s);
    }
    // What one axis leaves over is the other's.
    const double start_s = elapsed_s();
    EXPECT_EQ(run(request({ChartAxis::Lights, ChartAxis::Sampler})).measured, 2u);
    EXPECT_LE(elapsed_s() - start_s, 0.95 * 10);
    EXPECT_GE(elapsed_s() - start_s, 0.45 * 10);
}

TEST_F(ChartRun, TakesAReferenceFromAFile) {
    static_cast<void>(render_bytes({"--spp", "256", "--seed", "9"}, "reference.exr"));
    ChartRequest r = request({ChartAxis::Sampler});
    r.reference = path("reference.exr");
    EXPECT_EQ(run(r).measured, 1u);
    const json of = points()["cases"][0];
    EXPECT_EQ(of["reference"]["by"], "reference.exr");
    EXPECT_TRUE(of["reference"]["symmetric_mse"].is_null());
    for (const json& p : of["methods"][0]["points"]) EXPECT_TRUE(p["believed"]);
    EXPECT_NE(file_bytes(path("report/report.html")).find("its own error is not known"),
              std::string::npos);
}

TEST_F(ChartRun, RefusesATimeThatIsTooShortForAFirstLook) {
    take(1);  // nine samples of the reference alone: its part of 5 s is 2 s
    EXPECT_NE(refused(request({ChartAxis::Sampler})).find("give more time or a smaller ⟨size⟩"),
              std::string::npos);
    EXPECT_NE(refused(request({ChartAxis::Sampler, ChartAxis::Lights}))
                  .find("is too small for each of the axes"),
              std::string::npos);
}

TEST_F(ChartRun, LeavesOutAnAxisForWhichTheTimeIsTooShort) {
    after_first_case = [this] { take(1); };
    const ChartOutcome outcome = run(request({ChartAxis::Sampler, ChartAxis::Lights}));
    EXPECT_EQ(outcome.measured, 1u);
    ASSERT_EQ(cases_.size(), 2u);
    EXPECT_FALSE(cases_[0].methods.empty());
    EXPECT_TRUE(cases_[1].methods.empty());
    ASSERT_FALSE(cases_[1].of.remarks.empty());
    EXPECT_TRUE(cases_[1].of.remarks.back().starts_with("Left out: --budget"))
        << cases_[1].of.remarks.back();
}

TEST_F(ChartRun, OfNoiseDenoisesEachCountOfSamples) {
    run(request({ChartAxis::Noise}));
    ASSERT_EQ(cases_.size(), 1u);
    const auto& methods = cases_[0].methods;
    ASSERT_EQ(methods.size(), 3u);
    const auto& samples = methods[0].points;
    const auto& denoised = methods[2].points;
    EXPECT_EQ(methods[2].name, "denoised");
    ASSERT_GE(denoised.size(), 3u);
    EXPECT_EQ(denoised.front().samples, 2u) << "each half has one";
    for (size_t i = 0; i < denoised.size() && i + 1 < samples.size(); ++i) {
        EXPECT_EQ(denoised[i].samples, samples[i + 1].samples);
        EXPECT_NEAR(denoised[i].cpu_s().mean, samples[i + 1].cpu_s().mean, 1e-9);
    }
    const uint32_t shown = denoised[methods[2].shown].samples;
    const io::Picture picture =
        render({"--denoise", "--spp", std::to_string(shown)}, "denoised.exr");
    for (size_t c = 0; c < 3; ++c) {
        const int at = io::channel_index(picture, std::string("denoised.") + "RGB"[c]);
        ASSERT_GE(at, 0);
        for (size_t i = 0; i < kPixels; ++i)
            EXPECT_EQ(methods[2].picture.pixels[3 * i + c],
                      picture.pixels[i * picture.channels.size() + size_t(at)]);
    }
}

// Of a lens whose light is mostly ghosts, so that few samples show it.
TEST_F(ChartRun, OfGhostsLeavingThemOutIsOffByTheirLight) {
    ChartRequest asked = request({ChartAxis::Ghosts});
    asked.subject.request.scene = PETZVAL_ASSETS "/scenes/low_sun.glb";
    asked.subject.request.camera.lens = "takumar-50mm-f1.2";
    asked.subject.request.camera.coating = camera::Coating::Uncoated;
    asked.budget_s = 40;
    run(asked);
    ASSERT_EQ(cases_.size(), 1u);
    const auto& methods = cases_[0].methods;
    ASSERT_EQ(methods.size(), 2u);
    const auto error = [&](size_t method) {
        return methods[method].points.back().symmetric_mse().mean;
    };
    EXPECT_GT(error(0), 4 * error(1)) << error(0) << ' ' << error(1);
    EXPECT_EQ(cases_[0].of.methods[0].scene.camera.coating, camera::Coating::Uncoated);
}

TEST_F(ChartRun, GhostsAreThoseOfTheLensOfItsYearWhereNothingReflects) {
    const RenderSetup first = set_up_render(request({}).subject.request, [](const std::string&) {});
    const auto ghosts = [&](const std::string& lens, camera::Coating coating) {
        ChartSubject subject = request({}).subject;
        subject.request.camera.lens = lens;
        subject.request.camera.focus = FocusDistance{2};
        subject.request.camera.coating = coating;
        return chart_cases({ChartAxis::Ghosts}, subject,
                           [&](const SceneRequest& one) {
                               return set_up_view(first, one, [](const std::string&) {});
                           })
            .front();
    };
    const ChartCase year = ghosts("double-gauss-100mm-f2", camera::Coating::Ideal),
                    mgf2 = ghosts("double-gauss-100mm-f2", camera::Coating::MgF2);
    ASSERT_EQ(year.methods.size(), 2u);
    EXPECT_EQ(year.methods[0].scene.camera.coating, camera::Coating::Year);
    EXPECT_EQ(year.methods[0].scene.camera.ghosts, GhostUse::Off);
    EXPECT_EQ(year.methods[1].scene.camera.ghosts, GhostUse::Auto);
    EXPECT_EQ(year.reference.scene.camera.ghosts, GhostUse::Auto);
    EXPECT_EQ(mgf2.reference.scene.camera.coating, camera::Coating::MgF2);
    // Of a lens that nobody knows the year of, there is nothing to compare, and a reason.
    std::ofstream(path("bare.json"))
        << R"({"surfaces": [{"radius": 50, "thickness": 5, "semi_diameter": 8,
            "medium": {"n": 1.5}}, {"radius": -50, "thickness": 48, "semi_diameter": 8, "stop": true, "medium": null}]})";
    const ChartCase bare = ghosts(path("bare.json"), camera::Coating::Ideal);
    EXPECT_TRUE(bare.methods.empty());
    EXPECT_NE(bare.remarks.back().find("states no year"), std::string::npos) << bare.remarks.back();
}

TEST_F(ChartRun, StopsAndKeepsOnlyWhatIsWhole) {
    for (const double at_s : {0.01, 1., 4.}) {  // in the reference's warm-up, in it, in the race
        stop_at_s_ = elapsed_s() + at_s;
        const ChartOutcome outcome = run(request({ChartAxis::Sampler}));
        EXPECT_TRUE(outcome.stopped) << at_s;
        EXPECT_EQ(outcome.measured, 0u) << at_s;
        EXPECT_TRUE(cases_.empty()) << at_s;
        EXPECT_EQ(listing(), (std::set<std::string>{"studio.glb"})) << at_s;
    }
}

TEST_F(ChartRun, StoppedInTheSecondAxisKeepsTheFirst) {
    after_first_case = [this] { stop_at_s_ = elapsed_s() + 1; };
    const ChartOutcome outcome = run(request({ChartAxis::Sampler, ChartAxis::Lights}));
    EXPECT_TRUE(outcome.stopped);
    EXPECT_EQ(outcome.measured, 1u);
    ASSERT_EQ(points()["cases"].size(), 1u);
    EXPECT_EQ(points()["cases"][0]["axis"], "sampler");
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
};

// Whether the time is enough is the machine's; one of the two holds on any.
TEST_F(ChartCli, WritesAReportOrSaysThatTheTimeIsTooShort) {
    Words words =
        chart_words({"--axis", "lights", "--size", "8x8", "--budget", "4s", "-o", path("report")});
    std::erase(words, "--quiet");
    const Finished run = run_petzval(words);
    if (run.exit_code == 0) {
        for (const char* said :
             {"\n  reference: ", " samples, symmetric MSE ", "/s", "report.html\n"})
            EXPECT_NE(run.out.find(said), std::string::npos) << said << run.out;
        EXPECT_TRUE(file_bytes(path("report/report.html")).ends_with("</html>\n"));
        const json all = json::parse(file_bytes(path("report/points.json")));
        EXPECT_EQ(all["cases"][0]["axis"], "lights");
    } else {
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_NE(run.err.find("give more time"), std::string::npos) << run.err;
        EXPECT_EQ(listing(), (std::set<std::string>{"studio.glb"}));
    }
}

TEST_F(ChartCli, RefusesWhatItCannotDo) {
    const auto expect = [&](const Words& words, int exit_code, const std::string& part) {
        const std::string line = error_of(chart_words(words), exit_code);
        EXPECT_NE(line.find(part), std::string::npos) << line;
    };
    expect({"--axis", "colour", "-o", path("r")}, 2, "is none of camera, dispersion");
    expect({"--budget", "1s", "-o", path("r")}, 2, "--budget");
    expect({"--axis", "sampler", "--seeds", "4", "-o", path("r")}, 2, "--seeds");
    expect({"--axis", "sampler", "-o", path("x.csv")}, 2,
           path("x.csv") + "\" is named as a file; call it " + path("x"));
    expect({"--axis", "sampler", "-o", path("x.MD")}, 2, "call it " + path("x"));
    expect({"--axis", "sampler", "-o", scene_}, 3, "cannot be made a folder");
    expect({"--axis", "sampler", "-o", scene_ + "/none"}, 3, "studio.glb/none");
    expect({"--axis", "camera", "--camera", "plan", "-o", path("r")}, 2, "orthographic");
    expect({"--axis", "sampler", "--camera", "none", "-o", path("r")}, 2, "no camera \"none\"");
    static_cast<void>(render_bytes({}, "reference.exr"));
    expect({"--reference", path("reference.exr"), "--size", "16x8", "-o", path("r")}, 1,
           "give the same --size and --crop");
}

TEST_F(ChartCli, StopsAndSaysWhatThereIs) {
    Words words{"chart",  scene_,     "--size",   "16x16", "--axis", "sampler",
                "--axis", "spectral", "--budget", "24h",   "-o",     path("report")};
    Process run(words);
    // The first word of a scene that is open: by then signals ask the chart to stop.
    ASSERT_TRUE(run.wait_for_stderr("spectral: "));
    run.signal(SIGINT);
    const Finished stopped = run.wait();
    EXPECT_EQ(stopped.exit_code, 130);
    EXPECT_NE(stopped.err.find("stopped: nothing was measured whole"), std::string::npos)
        << stopped.err;
    EXPECT_EQ(listing(), (std::set<std::string>{"studio.glb"}));
}

}  // namespace
}  // namespace petzval::apps
