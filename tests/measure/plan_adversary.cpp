// SPDX-License-Identifier: Apache-2.0
// Plans of scenes that are made to fool them, judged by brute force. A row for each model whose
// error a plan predicts, and one for what it chose. All errors are roots of the symmetric MSE.
//
//   plan_adversary [--first N] [--count N] [--csv FILE] [--save FOLDER]
//
// A promise is broken where the true error's lower bound of 95 % lies above the prediction; models
// that the plan turns down as surely beyond the tolerance have none. Noise
// is judged alike, unless the plan says "at least". A choice is needless where a simpler model was
// turned down whose upper bound is below a third of the tolerance. The table goes to standard
// output, line by line; rows are added to the file of --csv, so a run that was cut short goes on
// with --first.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>

#include "apps/plan/plan.h"
#include "apps/plan/plan_wording.h"
#include "apps/request/parse.h"
#include "io/base/clock.h"
#include "io/base/error.h"
#include "tests/measure/plan_verdict.h"
#include "tests/measure/program.h"
#include "tests/support/tiny_gltf.h"

namespace petzval {
namespace {

using test::PlanScene;

struct Settings {
    uint32_t first = 0, count = 300;
    int threads = 2;
    JudgeBudget budget;
    std::string csv, save;
};

// ---- What is written -----------------------------------------------------------------------

std::string percent(double share) {
    return fmt::format("{:.3g}", 100 * share);
}

void print(const Verdict& v) {
    const std::string start = fmt::format("| {} | {}{} | {}", v.index, v.kind,
                                          v.decoy ? " (decoy)" : "", percent(v.tolerance));
    if (v.refused) fmt::print("{} | refused | | | | | {:.1f} |\n", start, v.plan_cpu_s);
    for (const Row& r : v.rows) {
        std::string noise, what = r.broken_twice() ? "TWICE " : r.broken() ? "ABOVE " : "";
        if (r.chosen) {
            noise = fmt::format("{} x: {} | {} from {}", v.samples, percent(v.noise_predicted),
                                percent(v.noise.value), percent(v.noise.low));
            if (v.noise_exceeded()) what += "NOISE ";
            if (v.needless) what += "needless ";
            if (v.beyond_tolerance()) what += "BEYOND";
        } else {
            noise = " | ";
        }
        fmt::print("{} | {}{} | {} | {} ({} to {}) | {} | {:.1f} + {:.1f} | {} |\n", start, r.model,
                   r.chosen ? " *" : "", percent(r.predicted), percent(r.bias.value),
                   percent(r.bias.low), percent(r.bias.high), noise, v.plan_cpu_s, v.truth_cpu_s,
                   what);
    }
    std::fflush(stdout);
}

void write_csv(const Verdict& v, std::ostream& out) {
    const auto line = [&](const std::string& model, const Row& r) {
        out << fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},", v.index, v.kind,
                           v.tolerance, model, r.predicted, r.bias.value, r.bias.low, r.bias.high,
                           int(r.chosen), r.chosen ? v.samples : 0);
        if (r.chosen)
            out << fmt::format("{:.6g},{:.6g},{:.6g},{}", v.noise_predicted, v.noise.value,
                               v.noise.low, int(v.at_least));
        else
            out << ",,,";
        out << fmt::format(",{:.2f},{},{},{}\n", v.plan_cpu_s, int(v.decoy), int(v.needless),
                           int(r.outside));
    };
    if (v.refused) line("refused", {});
    for (const Row& r : v.rows) line(r.model, r);
    out.flush();
}

constexpr double kMuch = 1.2;  ///< noise this many times as promised

struct Tally {
    int scenes = 0, refused = 0, rows = 0, above = 0, twice = 0, chosen_above = 0, chosen_twice = 0,
        noise = 0, noise_much = 0, beyond = 0, needless = 0;
    double plan_cpu_s = 0, truth_cpu_s = 0;

    void add(const Verdict& v) {
        ++scenes;
        refused += v.refused;
        for (const Row& r : v.rows) {
            ++rows;
            above += r.broken();
            twice += r.broken_twice();
            chosen_above += r.chosen && r.broken();
            chosen_twice += r.chosen && r.broken_twice();
        }
        noise += v.noise_exceeded();
        noise_much += v.noise_exceeded(kMuch);
        beyond += v.beyond_tolerance();
        needless += v.needless;
        plan_cpu_s += v.plan_cpu_s;
        truth_cpu_s += v.truth_cpu_s;
    }
    void print(const std::string& name) const {
        fmt::print(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1f} | {:.1f} |\n",
            name, scenes, refused, rows, above, twice, chosen_above, chosen_twice, noise,
            noise_much, beyond, needless, plan_cpu_s / scenes, truth_cpu_s / scenes);
    }
};

void summarise(const std::map<std::string, Tally>& kinds, const Tally& all) {
    fmt::print(
        "\n| kind | scenes | refused | predictions | above | above twice | chosen above | chosen "
        "above twice | noise exceeded | by a fifth | beyond tolerance | needless | plan, CPU s | "
        "truth, CPU s "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const auto& [name, tally] : kinds) tally.print(name);
    all.print("all");
}

void save(const Settings& s) {
    for (uint32_t i = s.first; i < s.first + s.count; ++i) {
        const PlanScene scene = test::plan_scene(i);
        const auto folder = std::filesystem::path(s.save) / fmt::format("{}_{}", i, scene.kind);
        std::filesystem::create_directories(folder);
        static_cast<void>(scene.save(folder));
        const std::vector<TruthPixel> pixels = truth_pixels(scene);
        fmt::print("{} {}  # {} pixels matter\n", (folder / "scene.gltf").string(), scene.options(),
                   std::count_if(pixels.begin(), pixels.end(),
                                 [](const TruthPixel& p) { return p.matters; }));
    }
}

int run(int argc, char** argv) {
    CLI::App app("Plans of scenes that are made to fool them.");
    Settings s;
    app.add_option("--first", s.first, "index of the first scene");
    app.add_option("--count", s.count, "of scenes");
    app.add_option("--threads", s.threads)->check(CLI::PositiveNumber);
    app.add_option("--csv", s.csv, "file that rows are added to");
    app.add_option("--truth-samples", s.budget.truth_samples,
                   "that measure a scene's truth, about");
    app.add_option("--plan-samples", s.budget.plan_samples, "that a plan may take");
    app.add_option("--save", s.save, "folder that scenes are written to; prints options of each");
    CLI11_PARSE(app, argc, argv);
    flush_denormals();
    if (!s.save.empty()) return save(s), 0;
    std::ofstream csv;
    if (!s.csv.empty()) {
        csv.open(s.csv, std::ios::app);
        if (!csv) throw io::OutputError(s.csv, "", "cannot be written");
        if (csv.tellp() == 0)
            csv << "scene,kind,tolerance,model,predicted,true,low,high,chosen,samples,"
                   "noise_predicted,noise_true,noise_low,at_least,plan_cpu_s,decoy,needless,"
                   "outside\n";
    }
    integrator::TbbExecutor executor(s.threads);
    std::map<std::string, Tally> kinds;
    Tally all;
    fmt::print(
        "errors in %; *: chosen\n\n"
        "| scene | kind | tolerance | model | predicted | true | noise predicted | true | CPU s | "
        "|\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    for (uint32_t i = s.first; i < s.first + s.count; ++i) {
        const Verdict v = judge(i, s.budget, executor);
        print(v);
        if (csv.is_open()) write_csv(v, csv);
        kinds[v.kind].add(v);
        all.add(v);
    }
    summarise(kinds, all);
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    return petzval::guarded(petzval::run, argc, argv);
}
