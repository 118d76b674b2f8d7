// SPDX-License-Identifier: Apache-2.0
#include "tests/measure/plan_verdict.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/plan/plan_wording.h"
#include "io/base/clock.h"
#include "io/base/error.h"
#include "tests/support/tiny_gltf.h"

namespace petzval {
namespace {

using test::PlanScene;

constexpr double kDarkFrames = 4;  ///< times as many samples as usual

Bounded roots(const Bounded& squares) {
    return {std::sqrt(squares.value), std::sqrt(squares.low), std::sqrt(squares.high)};
}

/// Whether a model has no error of its own but sends wavelengths through a lens in another way.
bool is_unbiased(apps::PlanModel model) {
    return model == apps::PlanModel::Hero || model == apps::PlanModel::Split ||
           model == apps::PlanModel::Full;
}

void measure(const apps::Plan& plan, const PlanScene& scene, const apps::PlanRequest& request,
             const JudgeBudget& budget, integrator::TbbExecutor& executor, Verdict& out) {
    const auto silent = [](const std::string&) {};
    const apps::RenderSetup first =
        executor.inside([&] { return apps::set_up_render(request.scene, silent); });
    std::vector<apps::RenderSetup> setups;
    std::vector<const apps::PlanCandidate*> candidates;  // with a bias
    const auto add = [&](const apps::SceneRequest& asked) {
        setups.push_back(executor.inside([&] { return apps::set_up_view(first, asked, silent); }));
    };
    std::optional<size_t> chosen;
    for (const apps::PlanCandidate& c : plan.candidates) {
        if (is_unbiased(c.model)) continue;
        if (c.model == plan.chosen) chosen = candidates.size();
        candidates.push_back(&c);
        add(c.scene);
    }
    add(plan.candidates.back().scene);
    std::vector<const apps::RenderSetup*> models;
    for (const apps::RenderSetup& setup : setups) models.push_back(&setup);
    // Most of a large frame is dark, and costs little.
    const bool large =
        scene.matters.front() != Rect{0, 0, scene.request.size.x, scene.request.size.y};
    const double samples = budget.truth_samples * (large ? kDarkFrames : 1);
    TruthPictures pictures = truth_pictures(scene, request, models, samples, executor);
    for (size_t i = 0; i < candidates.size(); ++i) {
        const apps::PlanCandidate& c = *candidates[i];
        const Bounded bias = roots(square_bias(pictures, i, true));
        const Bounded outside = roots(square_bias(pictures, i, false));
        if (outside.low > 0.05 * bias.high)
            fmt::print("  {}: {:.2f} % of error outside of what matters\n", apps::name_of(c.model),
                       100 * outside.low);
        out.rows.push_back({apps::name_of(c.model), c.predicted(), bias, i == chosen, c.outside});
        if (c.model < plan.chosen && !c.inside && bias.high < scene.tolerance / 3)
            out.needless = true;
    }
    if (!chosen) {  // of no bias; the fullest tells where its noise is
        out.rows.push_back({apps::name_of(plan.chosen), plan.bias, {}, true});
        chosen = candidates.size();
        if (plan.scene.camera.dispersion != plan.candidates.back().scene.camera.dispersion) {
            add(plan.scene);
            pictures.shown.push_back({});
            render_replicates(setups.back(), request, pictures.pixels, pictures.samples, 0,
                              executor, pictures.shown.back());
            ++*chosen;
        }
    }
    out.noise = roots(
        square_noise(pictures, *chosen, setups[*chosen], request, plan.samples, samples, executor));
}

}  // namespace

const Row* Verdict::chosen() const {
    const auto found =
        std::find_if(rows.begin(), rows.end(), [](const Row& r) { return r.chosen; });
    return found == rows.end() ? nullptr : &*found;
}

Verdict judge(uint32_t index, const JudgeBudget& budget, integrator::TbbExecutor& executor) {
    const PlanScene scene = test::plan_scene(index);
    const TempFolder folder;
    apps::PlanRequest request;
    request.scene = scene.save(folder.path);
    request.tolerance = scene.tolerance;
    Verdict out;
    out.index = index;
    out.kind = scene.kind;
    out.decoy = scene.decoy;
    out.tolerance = scene.tolerance;
    const double start_s = io::process_cpu_s();
    try {
        const apps::Plan plan = apps::make_plan(
            request, executor, [](const std::string&) {}, budget.plan_samples);
        out.plan_cpu_s = io::process_cpu_s() - start_s;
        out.samples = plan.samples;
        out.noise_predicted = plan.noise;
        out.at_least = plan.noise_at_least;
        measure(plan, scene, request, budget, executor, out);
        out.truth_cpu_s = io::process_cpu_s() - start_s - out.plan_cpu_s;
    } catch (const io::ArgumentError& e) {
        if (std::string(e.what()).find("would take") == std::string::npos) throw;
        out.refused = true;
        out.plan_cpu_s = io::process_cpu_s() - start_s;
    }
    return out;
}

}  // namespace petzval
