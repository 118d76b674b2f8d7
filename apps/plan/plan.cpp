// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/plan/pilot.h"
#include "apps/plan/plan_comparison.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

/// Pilot pixels of a plan, and bounds of those of a render that chooses for itself.
constexpr int kPilotPixels = 4096, kFewestPilotPixels = 256, kMostPilotPixels = 8192;
/// Samples for each pixel of the frame that a render may spend on choosing its model: with the
/// choice of the mode they stay below a hundredth of 64.
constexpr double kPilotShare = 0.2;
/// Pilot samples of each replicate, for a render: many pilot pixels with few samples see more of
/// the frame.
constexpr double kPilotPixelSamples = 4;

// Factor within which costs count as equal: they are known no better, and the simpler model is
// taken.
constexpr double kAsCheap = 1.05;

size_t cheapest(const std::vector<PlanCandidate>& all, double tolerance) {
    const auto cost = [&](const PlanCandidate& c) { return c.samples_for(tolerance) * c.rays; };
    double least = cost(all.back());
    for (const PlanCandidate& c : all)
        if (c.inside) least = std::min(least, cost(c));
    size_t best = 0;
    while (!all[best].inside || cost(all[best]) > kAsCheap * least) ++best;
    return best;
}

// Plan for spectra through a lens: nothing is left out of them, and only the mode is chosen.
Plan plan_with_bins(const PlanRequest& request, const RenderSetup& first,
                    integrator::TbbExecutor& executor, const io::Notice& notice,
                    double most_samples) {
    ModeChoice found = choose_mode(request, first, executor);
    PlanRequest resolved = request;
    resolved.scene.camera.dispersion = found.mode();
    Plan plan = make_plan(resolved, executor, notice, most_samples);
    plan.dispersion_px = found.dispersion_px;
    plan.measured_mode = std::move(found);
    return plan;
}

// Setup in place of the first: the times of both count, and a plan decided.
RenderSetup replaced(const RenderSetup& first, const SceneRequest& scene,
                     integrator::TbbExecutor& executor) {
    RenderSetup setup = view_of(first, scene, executor);
    setup.from.load_s += first.from.load_s;
    setup.from.bvh_s += first.from.bvh_s;
    setup.from.spectral.reasons = first.from.spectral.reasons;
    if (first.from.spectral.by == DecidedBy::Request) setup.from.spectral.by = DecidedBy::Plan;
    return setup;
}

}  // namespace

const PlanCandidate* Plan::find(PlanModel model) const {
    const auto found = std::find_if(candidates.begin(), candidates.end(),
                                    [&](const PlanCandidate& c) { return c.model == model; });
    return found == candidates.end() ? nullptr : &*found;
}

Plan make_plan(const PlanRequest& request, integrator::TbbExecutor& executor,
               const io::Notice& notice, double most_samples) {
    std::vector<std::string> notices;
    const RenderSetup first = executor.inside([&] {
        return set_up_render(request.scene,
                             [&](const std::string& text) { notices.push_back(text); });
    });
    const PlanOpen open(request.scene, first);
    if (open.dispersion_mode && !open.dispersion)
        return plan_with_bins(request, first, executor, notice, most_samples);
    for (const std::string& text : notices) notice(text);
    PlanComparison compared(request, first, open, kPilotPixels, executor);
    compared.add_simpler_cameras();
    if (open.spectral) compared.add_rgb();
    if (open.dispersion) {
        compared.add_shared();
        compared.add_unbiased(PlanModel::Hero, camera::DispersionMode::Hero);
    }
    compared.measure(most_samples, true);

    Plan plan;
    plan.requested = first.from;
    plan.dispersion_open = open.dispersion;
    plan.anything_open = open.any();
    if (open.dispersion) plan.dispersion_px = compared.dispersion_px();
    plan.candidates = compared.candidates();
    const size_t best = cheapest(plan.candidates, request.tolerance);
    const PlanCandidate& chosen = plan.candidates[best];
    plan.scene = chosen.scene;
    plan.chosen = chosen.model;
    plan.bias = chosen.predicted();
    double tolerance = request.tolerance;  // that is left for the model and its noise
    if (!replaces_camera(chosen.model)) {
        plan.precision = find_precision(request, first, chosen.scene, executor);
        if (plan.precision) {
            plan.scene.camera.precision = plan.precision->precision;
            if (plan.precision->precision == camera::Precision::Float) {
                plan.bias = std::hypot(plan.bias, std::sqrt(plan.precision->square));
                tolerance = std::sqrt(tolerance * tolerance - plan.precision->square);
            }
        }
        if (first.from.camera.traced)
            plan.ghosts = find_ghosts(compared, first, chosen.scene, best);
    }
    plan.diffraction = diffraction_effect(first.view, request.scene.size,
                                          double(first.from.camera.focus_m), first.prepared);
    plan.lights_asked = request.scene.light_choice.has_value();
    if (!plan.lights_asked) plan.lights = find_lights(compared, first, chosen.scene, best);
    if (plan.lights) plan.scene.light_choice = plan.lights->kind;
    const double samples = std::ceil(chosen.samples_for(tolerance));
    if (!(samples <= kMostPlannedSamples))
        throw io::ArgumentError(
            "⟨tolerance⟩", "",
            "would take more than {:.2g} samples of each pixel; give a larger one",
            kMostPlannedSamples);
    plan.samples = static_cast<uint64_t>(samples);
    // Standard errors of spectra come from as many replicates, each with the same share of the
    // samples.
    if (request.scene.spectral.bins)
        plan.samples = (plan.samples + kReplicates - 1) / kReplicates * kReplicates;
    plan.noise = std::sqrt(chosen.variance_with(plan.samples));
    plan.first_noise = std::sqrt(chosen.variance_with(1));
    plan.noise_at_least = chosen.noise_at_least();
    plan.rare = chosen.rare;
    plan.threads = executor.threads();
    plan.load_s = first.from.load_s + first.from.bvh_s;
    plan.cpu_s = compared.cpu_s_per_sample(best) * static_cast<double>(plan.samples) *
                 request.scene.size.x * request.scene.size.y;
    return plan;
}

namespace {

RenderSetup set_up_like(const PlanRequest& request, const io::Notice& notice,
                        const PhaseSink& begins) {
    if (request.like) return set_up_view(*request.like, request.scene, notice, begins);
    return set_up_render(request.scene, notice, begins, request.frames);
}

}  // namespace

AutoSetup set_up_planned(const PlanRequest& request, integrator::TbbExecutor& executor,
                         const io::Notice& notice, const PhaseSink& begins) {
    AutoSetup out;
    RenderSetup first = executor.inside([&] { return set_up_like(request, notice, begins); });
    const PlanOpen open(request.scene, first);
    AutoChoice& choice = out.choice;
    std::optional<SceneRequest> other;  // a request other than what was set up
    const double most_samples = kPilotShare * request.scene.size.x * request.scene.size.y;
    const int models = (open.spectral ? 1 : 0) + (open.dispersion ? 2 : 1);
    const double affordable = most_samples / (kPilotReplicates * kPilotPixelSamples * models);
    double predicted_error = 0;
    if (open.any() && affordable >= kFewestPilotPixels) {
        PlanComparison compared(request, first, open,
                                static_cast<int>(std::min<double>(affordable, kMostPilotPixels)),
                                executor);
        if (open.spectral) compared.add_rgb();
        if (open.dispersion) compared.add_shared();
        if (compared.may_find_one()) {
            compared.measure(most_samples, false);
            choice.candidates = compared.candidates();
            choice.dispersion_compared = open.dispersion;
        }
        const auto chosen = std::find_if(choice.candidates.begin(), choice.candidates.end(),
                                         [](const PlanCandidate& c) { return c.inside; });
        const auto index = static_cast<size_t>(chosen - choice.candidates.begin());
        // The last is the fullest model. A choice that the pilot does not clear stays as it is.
        if (index + 1 < choice.candidates.size()) {
            choice.taken = index;
            other = chosen->scene;
            predicted_error = chosen->predicted();
            if (open.dispersion) choice.dispersion = camera::DispersionMode::Shared;
            choice.dispersion_px = compared.dispersion_px();
        }
    }
    if (open.dispersion_mode) choice.dispersive_lens = first.from.camera.dispersive_lens;
    if (open.dispersion_mode && !other) {
        choice.measured_mode = choose_mode(request, first, executor);
        other = choice.measured_mode->scene;
        choice.dispersion = choice.measured_mode->mode();
        choice.dispersion_px = choice.measured_mode->dispersion_px;
    }
    out.setup = other ? replaced(first, *other, executor) : std::move(first);
    out.setup.from.spectral.predicted_error = predicted_error;
    return out;
}

}  // namespace petzval::apps
