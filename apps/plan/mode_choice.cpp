// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/mode_choice.h"

#include <memory>
#include <utility>

#include "apps/plan/pilot.h"
#include "apps/setup/equivalent_camera.h"
#include "camera/setup/lateral_dispersion.h"

namespace petzval {
namespace {

// 256 pixels, 4 replicates, 4 samples, 2 modes.
constexpr int kPixels = 256;
constexpr uint32_t kSamples = 4;

}  // namespace

ModeChoice choose_mode(const PlanRequest& request, const RenderSetup& first,
                       TbbExecutor& executor) {
    ModeChoice out{0, {}, resolved_request(first)};
    out.scene.spectral.mode = SpectralMode::Wavelengths;
    const auto with = [&](DispersionMode mode) {
        out.scene.camera.dispersion = mode;
        return executor.inside(
            [&] { return set_up_view(first, out.scene, [](const std::string&) {}); });
    };
    const Pilot pilot(request.scene.size, kPixels, executor);
    const auto sampled = [&](DispersionMode mode) {
        auto model = pilot.model(with(mode), request.job, request.path);
        pilot.sample(*model, kSamples);
        return model;
    };
    const auto split = sampled(DispersionMode::Split), hero = sampled(DispersionMode::Hero);
    const auto effort = [&](const PilotModel& model) {
        return pilot.variance(model, *split).mean * model.rays_per_sample();
    };
    out.by_effort = {ModeCost{DispersionMode::Hero, effort(*hero)},
                     ModeCost{DispersionMode::Split, effort(*split)}};
    if (out.by_effort[1].effort < out.by_effort[0].effort)
        std::swap(out.by_effort[0], out.by_effort[1]);
    const RenderSetup shared = with(DispersionMode::Shared);
    out.dispersion_px = lateral_dispersion_px(
        *split->setup().view.camera, *shared.view.camera, split->setup().view.observer,
        split->setup().from.camera.focus_plane(), request.scene.size);
    out.scene.camera.dispersion = out.mode();
    return out;
}

}  // namespace petzval
