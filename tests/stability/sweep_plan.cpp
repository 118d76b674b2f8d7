// SPDX-License-Identifier: Apache-2.0
// What a plan says of the noise of a lamp that its pilot hardly meets.
#include <fmt/format.h>

#include <numbers>

#include "apps/plan/pilot_error.h"
#include "apps/plan/plan_types.h"
#include "apps/plan/rare_light.h"
#include "camera/models/thin_lens.h"
#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

constexpr double kPlanFocal_mm = 50, kPlanFilm_px_mm = 0.006, kPlanFocus_m = 1, kPlanBehind_m = 10,
                 kFstop = 1.4;
constexpr V2i kFrame{64, 36};
constexpr uint32_t kPlanSamples = 32;  ///< of each replicate, as plans take them

struct Planned {
    double met = 0;  ///< camera paths that met the lamp
    apps::PlanCandidate candidate;
};

// A frame within the circle of confusion of a square lamp: any of its pixels meets the lamp with
// the same chance.
Planned planned(double side_m) {
    const World world = lamp_ahead(side_m, kPlanBehind_m);
    apps::RenderSetup setup;
    const auto borrowed = [](const auto& owned) {
        return std::shared_ptr<std::remove_reference_t<decltype(owned)>>(std::shared_ptr<void>(),
                                                                         &owned);
    };
    setup.prepared.scene = borrowed(world.scene);
    setup.prepared.bvh = borrowed(*world.bvh);
    setup.prepared.lights = borrowed(*world.lights);
    const double film_mm = kPlanFocal_mm / (1 - kPlanFocal_mm / (kPlanFocus_m * 1e3));
    const auto yfov_rad =
        static_cast<float>(2 * std::atan(kFrame.y * kPlanFilm_px_mm / 2 / film_mm));
    setup.view.still = std::make_unique<camera::ThinLensCamera>(camera::ThinLens{
        M44f(), yfov_rad, float(kFrame.x) / float(kFrame.y),
        camera::Iris(camera::Disk{}, kPlanFocal_mm / (2 * kFstop)), float(kPlanFocus_m)});
    setup.view.camera = setup.view.still;
    const std::vector<SmallFeature> features = small_features_of(world.scene);
    const std::vector<camera::FilmRegion> regions =
        camera::film_regions(*setup.view.still, kFrame, features);
    const std::vector<apps::SeenLamp> lamps = apps::seen_lamps(setup, kFrame, features, regions);
    integrator::TbbExecutor executor(1);
    const apps::Pilot pilot(kFrame, kFrame.x * kFrame.y, executor);
    integrator::RenderJob job;
    job.sampler = SamplerKind::Independent;  // as the closed form has it
    const auto model = pilot.model(std::move(setup), job, integrator::PathOptions());
    pilot.sample(*model, kPlanSamples);
    const std::vector<V3d> least = apps::least_means(pilot, *model, lamps);
    const double floor = apps::pilot_floor(pilot, *model, least);
    Planned out;
    out.candidate.noise = apps::noise_of(pilot, *model, {model.get(), model.get(), floor, least});
    out.candidate.rare = apps::rare_light(pilot, *model, lamps, true, floor);
    for (size_t p = 0; p < pilot.pixels(); ++p)
        for (const V3d& mean : model->means(p)) out.met += mean.x * kPlanSamples;
    return out;
}

double share_of(double side_m) {
    const double blur_m =
        kPlanFocal_mm / kFstop * 1e-3 * (kPlanBehind_m - kPlanFocus_m) / kPlanFocus_m;
    return side_m * side_m / (std::numbers::pi / 4 * blur_m * blur_m);
}

}  // namespace

Finding planned_noise() {
    Finding f{.method = "Noise that plans predict",
              .fails = "variance of the prediction, called \"at least\""};
    f.sweep = fmt::format(
        "A thin lens of {:g} mm at f/{:g} in focus at {:g} m, and a square lamp {:g} m away on "
        "black: {} x {} pixels within its blur, all looked at with {} samples in four replicates. "
        "By the lamp's side: its share of the blur, the paths that met it and those that were to "
        "be expected, the variance of a sample over the squared mean, what the plan makes of it, "
        "and whether it says \"at least\".",
        kPlanFocal_mm, kFstop, kPlanFocus_m, kPlanBehind_m, kFrame.x, kFrame.y, kPlanSamples);
    f.table.columns = {"side (m)", "share", "met", "expected", "variance", "planned", "says"};
    const double paths = double(kFrame.x) * kFrame.y * apps::kPilotReplicates * kPlanSamples;
    double worst = 1;
    for (const double side : {0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
        const Planned p = planned(side);
        const double share = share_of(side), truth = 1 / share - 1;
        const double variance =
            p.candidate.noise.variances.back().mean * kPlanSamples + p.candidate.rare.noise;
        add_row(f, side, share, p.met, share * paths, truth, variance,
                p.candidate.noise_at_least() ? "at least" : "about");
        if (!p.candidate.noise_at_least())
            worst = std::max({worst, variance / truth, truth / variance});
    }
    const auto at_least = first_failure(
        0.1, 1e-5, [](double side) { return planned(side).candidate.noise_at_least(); }, 2);
    f.where = fmt::format(
        "Below a side of {} m, {} of the blur, the plan says \"at least\": fewer than 16 paths "
        "meet the lamp. Above it the planned variance is within a factor of {} of the closed form",
        number(at_least), percent(share_of(at_least.value_or(0))), number(worst));
    f.instead =
        "The figure is calculated from the lamp's size and radiance, called \"at least\", and the "
        "reason is given. What a plan does not know of is missing from it: lamps seen in curved "
        "mirrors, for instance.";
    return f;
}

}  // namespace petzval::stability
