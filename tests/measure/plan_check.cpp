// SPDX-License-Identifier: Apache-2.0
// Predicted against measured errors, for every lens that ships or those that are named, on the
// scenes that are named. What is measured comes from other pixels, other seeds and more samples, of
// the lens as it is: nothing is parted further. A prediction is too low where it lies below the
// measured error's lower bound of 95 %, and too careful where it is over three times the upper one
// and over a quarter of the tolerance: the plan measures no closer than that. The row "all" is
// the error with the samples that the plan asks for, noise included.
//
//   plan_check SCENE... [--lens NAME ...] [--size ...] [--tolerance ...]
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/plan/pilot_error.h"
#include "apps/plan/plan.h"
#include "apps/plan/plan_wording.h"
#include "apps/request/parse.h"
#include "io/base/error.h"
#include "io/lens/lens_file.h"
#include "tests/measure/program.h"

namespace petzval {
namespace {

constexpr uint32_t kSeed = 1;  ///< not the plan's

struct Settings {
    std::vector<std::string> scenes, lenses;
    std::string size = "160x90", tolerance = "10%";
    float focus_m = 2;
    int pixels = 1024;
    uint32_t most_samples = 256;
    double plan_samples = 1e6;
};

struct Tally {
    int rows = 0, too_low = 0, too_careful = 0, small = 0;
    int simple = 0, needless = 0;  ///< plans where a simpler model does by far, and that refuse it
    double worst_low = 0, worst_careful = 0;  ///< ratios
};

std::string percent(double square) {
    return fmt::format("{:.2f}", 100 * std::sqrt(std::max(square, 0.)));
}

// measured: of the square.
void judge(const std::string& where, const std::string& name, double predicted,
           apps::Estimate measured, double tolerance, bool chosen, Tally& tally) {
    constexpr double kOneSided95 = 1.645, kTooCareful = 3, kSmallShare = 0.25;
    const double low = measured.mean - kOneSided95 * measured.error;
    const double high = std::max(measured.mean, 0.) + kOneSided95 * measured.error;
    const double square = predicted * predicted;
    const bool too_low = square < low, small = predicted <= kSmallShare * tolerance;
    const bool too_careful = !small && square > kTooCareful * kTooCareful * high;
    ++tally.rows;
    tally.too_low += too_low;
    tally.too_careful += too_careful;
    tally.small += small;
    if (too_low) tally.worst_low = std::max(tally.worst_low, std::sqrt(low / square));
    if (too_careful) tally.worst_careful = std::max(tally.worst_careful, std::sqrt(square / high));
    fmt::print("| {} | {}{} | {} | {} | {} to {} | {} |\n", where, name, chosen ? " *" : "",
               percent(square), percent(measured.mean), percent(low), percent(high),
               too_low       ? "TOO LOW"
               : too_careful ? "TOO CAREFUL"
               : small       ? "small"
                             : "");
    std::fflush(stdout);
}

void check(const std::string& scene, const std::string& lens, const Settings& settings,
           float focus_m, integrator::TbbExecutor& executor, Tally& tally) {
    const auto silent = [](const std::string&) {};
    apps::PlanRequest request;
    request.scene.scene = scene;
    request.scene.size = apps::parse_size("--size", settings.size);
    request.scene.camera.lens = lens;
    if (focus_m > 0) request.scene.camera.focus = apps::FocusDistance{focus_m};
    request.tolerance = apps::parse_share("--tolerance", settings.tolerance);
    const apps::Plan plan = apps::make_plan(request, executor, silent, settings.plan_samples);
    const apps::RenderSetup first = apps::set_up_render(request.scene, silent);
    const apps::Pilot pilot(request.scene.size, settings.pixels, executor, kSeed);
    std::vector<std::unique_ptr<apps::PilotModel>> models;
    const auto samples =
        static_cast<uint32_t>(std::min<uint64_t>(plan.samples, settings.most_samples));
    for (const apps::PlanCandidate& c : plan.candidates) {
        models.push_back(
            pilot.model(apps::set_up_view(first, c.scene, silent), request.job, request.path));
        pilot.sample(*models.back(), std::max(samples, 64u));
    }
    const apps::PilotModel& full = *models.back();
    const double floor = apps::pilot_floor(pilot, full);
    const std::string where =
        fmt::format("{} | {}", std::filesystem::path(scene).stem().string(), lens);
    bool simple = false, needless = false;
    for (size_t i = 0; i < models.size(); ++i) {
        const apps::PlanCandidate& c = plan.candidates[i];
        const bool chosen = c.model == plan.chosen, fullest = i + 1 == models.size();
        apps::Estimate square;
        if (!fullest) {
            square = apps::square_error(pilot, {{models[i].get(), 1}, {&full, -1}},
                                        {models[i].get(), &full, floor});
            judge(where, apps::name_of(c.model), c.predicted(), square, request.tolerance, chosen,
                  tally);
            const double third = std::pow(request.tolerance / 3, 2);
            const bool does = square.high() < third && c.model < apps::PlanModel::Hero;
            simple = simple || does;
            needless = needless || (does && c.model < plan.chosen && !c.inside);
        }
        if (!chosen) continue;
        const auto chosen_model =
            pilot.model(apps::set_up_view(first, c.scene, silent), request.job, request.path);
        pilot.sample(*chosen_model, samples);
        const apps::Estimate noise =
            apps::noise_of(pilot, *chosen_model, {chosen_model.get(), &full, floor})
                .variances.back();
        const double scale = double(samples) / double(plan.samples);
        judge(where, fmt::format("all, {} samples", plan.samples), plan.error(),
              {square.mean + noise.mean * scale, std::hypot(square.error, noise.error * scale)},
              request.tolerance, true, tally);
    }
    tally.simple += simple;
    tally.needless += needless;
}

int run(int argc, char** argv) {
    CLI::App app("Predicted against measured errors.");
    Settings s;
    app.add_option("scene", s.scenes)->required();
    app.add_option("--lens", s.lenses, "default: all that ship")->allow_extra_args(false);
    app.add_option("--size", s.size);
    app.add_option("--tolerance", s.tolerance);
    app.add_option("--focus", s.focus_m, "metres; 0: as render finds it");
    app.add_option("--pixels", s.pixels, "that are measured");
    app.add_option("--samples", s.most_samples,
                   "of each of four replicates of a pixel, when measuring");
    app.add_option("--plan-samples", s.plan_samples, "that a plan may take");
    CLI11_PARSE(app, argc, argv);
    flush_denormals();
    if (s.lenses.empty())
        for (const io::LensSummary& lens : io::list_lenses()) s.lenses.push_back(lens.name);
    integrator::TbbExecutor executor(2);
    Tally tally;
    fmt::print("{}, tolerance {}; errors in %; *: chosen\n\n", s.size, s.tolerance);
    fmt::print(
        "| scene | lens | model | predicted | measured | 95 % | |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const std::string& scene : s.scenes)
        for (const std::string& lens : s.lenses) {
            try {
                check(scene, lens, s, s.focus_m, executor, tally);
            } catch (const io::ArgumentError& e) {  // a long lens that cannot focus so near
                if (s.focus_m > 0)
                    check(scene, lens, s, 10 * s.focus_m, executor, tally);
                else
                    fmt::print("| {} | {} | {} |\n", scene, lens, e.what());
            }
        }
    fmt::print(
        "\n{} predictions, {} of them \"below a quarter of the tolerance\"; {} too low (at "
        "most {:.2f} times), {} too careful (at most {:.1f} times)\n",
        tally.rows, tally.small, tally.too_low, tally.worst_low, tally.too_careful,
        tally.worst_careful);
    fmt::print(
        "{} plans have a model whose error is below a third of the tolerance; {} refuse it\n",
        tally.simple, tally.needless);
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    return petzval::guarded(petzval::run, argc, argv);
}
