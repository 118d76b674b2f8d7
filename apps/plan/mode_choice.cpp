// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/mode_choice.h"

#include <algorithm>
#include <utility>

#include "apps/plan/pilot_error.h"
#include "apps/setup/equivalent_camera.h"
#include "camera/setup/lateral_dispersion.h"

namespace petzval::apps {
namespace {

// Many samples of few pixels: in a smooth picture well spread samples bring the noise of split rays
// down faster than that of hero rays, which a few would not show.
constexpr int kFewestPixels = 128, kMostPixels = 512;
constexpr uint32_t kSamples = 16;

}  // namespace

ModeChoice choose_mode(const PlanRequest& request, const RenderSetup& first,
                       integrator::TbbExecutor& executor) {
    ModeChoice out{0, {}, resolved_request(first)};
    out.scene.spectral.mode = SpectralMode::Wavelengths;
    // Ghosts and diffraction take part in each way alike, and take time.
    const GhostUse ghosts = std::exchange(out.scene.camera.ghosts, GhostUse::Off);
    const DiffractionUse diffraction =
        std::exchange(out.scene.camera.diffraction, DiffractionUse::Off);
    const auto with = [&](camera::DispersionMode mode) {
        out.scene.camera.dispersion = mode;
        return view_of(first, out.scene, executor);
    };
    // A quarter of a sample for each pixel of the frame, within bounds.
    const double pixels =
        0.25 * request.scene.size.x * request.scene.size.y / (2. * kPilotReplicates * kSamples);
    const Pilot pilot(request.scene.size,
                      static_cast<int>(std::clamp<double>(pixels, kFewestPixels, kMostPixels)),
                      executor);
    integrator::RenderJob job = request.job;
    job.replicates = 1;  // those of spectra would leave two samples to each
    const auto sampled = [&](camera::DispersionMode mode) {
        auto model = pilot.model(with(mode), job, request.path);
        pilot.sample(*model, kSamples);
        return model;
    };
    const auto split = sampled(camera::DispersionMode::Split),
               hero = sampled(camera::DispersionMode::Hero);
    const double floor = pilot_floor(pilot, *split);
    const auto noise = [&](const PilotModel& model) {
        return noise_of(pilot, model, {split.get(), split.get(), floor});
    };
    const auto ratio = typical_ratio(noise(*hero), noise(*split));
    out.by_effort = {
        ModeCost{camera::DispersionMode::Hero, ratio ? *ratio * hero->rays_per_sample() : 0},
        ModeCost{camera::DispersionMode::Split, ratio ? split->rays_per_sample() : 0}};
    if (out.by_effort[1].effort < out.by_effort[0].effort)
        std::swap(out.by_effort[0], out.by_effort[1]);
    const RenderSetup shared = with(camera::DispersionMode::Shared);
    out.dispersion_px = camera::lateral_dispersion_px(
        *split->setup().view.still, *shared.view.still, split->setup().view.observer,
        split->setup().from.camera.focus_plane(), request.scene.size);
    out.scene.camera.dispersion = out.mode();
    out.scene.camera.ghosts = ghosts;
    out.scene.camera.diffraction = diffraction;
    return out;
}

}  // namespace petzval::apps
