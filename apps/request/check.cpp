// SPDX-License-Identifier: Apache-2.0
// What does not go together in a request or an order.
#include <fmt/format.h>

#include <algorithm>

#include "apps/request/file_names.h"
#include "apps/request/parse.h"
#include "core/film/spectral_film.h"
#include "integrator/render/noise_target.h"

namespace petzval::apps {
namespace {

void refuse(const char* option, const std::string& why) {
    throw ValueError(option, why);
}

void check_camera(const CameraRequest& camera, V2i frame) {
    if (camera.look_at && camera.name) refuse("⟨look-at⟩", "excludes ⟨camera⟩");
    if (camera.pose && camera.look_at) refuse("⟨pose⟩", "excludes ⟨look-at⟩");
    if (camera.fstop && camera.lens_radius_m) refuse("⟨fstop⟩", "excludes ⟨lens-radius⟩");
    if (camera.focus) check_inside("⟨focus⟩", *camera.focus, frame);
    if (camera.exposure != ExposureMode::Photographic && camera.iso != CameraRequest().iso)
        refuse("⟨exposure-mode⟩", "⟨iso⟩ has no effect but with photographic");
}

void check_moment(const MomentRequest& moment, ExposureMode mode) {
    if (!moment.at && !moment.animations.empty()) refuse("⟨animation⟩", "needs a time: ⟨at⟩ 1s");
    if (!moment.at && moment.loop) refuse("⟨loop⟩", "needs a time: ⟨at⟩ 1s");
    if (moment.shutter && !moment.at && mode != ExposureMode::Photographic)
        refuse("⟨shutter⟩", "has no effect but with ⟨at⟩, or with ⟨exposure-mode⟩ photographic");
    if (!moment.shutter && !moment.shutter_curve.empty())
        refuse("⟨shutter-curve⟩", "needs ⟨shutter⟩");
}

void check_crop(const Crop& crop, V2i frame_px, bool to_noise) {
    const integrator::NoiseCells frame{frame_px};
    if (const auto* band = std::get_if<FrameBand>(&crop)) {
        if (const int most = frame.cells().y; band->of > most)
            refuse("⟨crop⟩",
                   fmt::format("{}/{} asks for {} bands; the number of bands of {} rows is at most "
                               "{}, as each has {} or a little more",
                               band->part, band->of, band->of, frame_px.y, most,
                               integrator::NoiseCells::kCell_px));
        return;
    }
    const Rect rect = std::get<Rect>(crop);
    check_inside("⟨crop⟩", rect, frame_px);
    if (const Rect whole = frame.whole_cells(rect); to_noise && whole != rect)
        refuse("⟨crop⟩", fmt::format("with ⟨noise⟩ is of whole cells of {0}x{0} pixels or a "
                                     "little more: {1},{2},{3},{4} holds it",
                                     integrator::NoiseCells::kCell_px, whole.x0, whole.y0,
                                     whole.width(), whole.height()));
}

void check_samples(const SampleRequest& samples, bool bins) {
    if (samples.noise && samples.range)
        refuse("⟨noise⟩",
               "excludes a range of samples: which of them a pixel needs is known as they come; "
               "machines share a picture by ⟨crop⟩");
    if (samples.noise && samples.count && *samples.count < integrator::kLeastOfCell)
        refuse("⟨spp⟩",
               fmt::format("to tell the noise takes at least {}", integrator::kLeastOfCell));
    if (samples.range && samples.count)
        refuse("⟨spp⟩", "is a number of samples or a range of them");
    if (samples.range && samples.time_limit_s)
        refuse("⟨time-limit⟩", "excludes a range of samples");
    if (bins && !samples.range && samples.count.value_or(kUsualSamples) < kReplicates)
        refuse("⟨spp⟩", fmt::format("the standard errors of ⟨bins⟩ need at least {}", kReplicates));
}

void check_denoise(const RenderRequest& request) {
    if (request.samples.noise && request.crop)
        refuse("⟨crop⟩",
               "excludes ⟨noise⟩ with ⟨denoise⟩: the error is that of the full frame; leave out "
               "one of the three");
    if (!request.samples.range && request.samples.count && *request.samples.count < kHalves)
        refuse("⟨denoise⟩", "needs two halves of samples: ⟨spp⟩ 2 at least");
}

}  // namespace

Rect pixels_of(const std::optional<Crop>& crop, V2i frame_px) {
    if (!crop) return {0, 0, frame_px.x, frame_px.y};
    if (const Rect* rect = std::get_if<Rect>(&*crop)) return *rect;
    const auto [part, of] = std::get<FrameBand>(*crop);
    const integrator::NoiseCells frame{frame_px};
    const int rows = frame.cells().y;
    return {0, frame.cell(0, rows * (part - 1) / of).y0, frame_px.x,
            frame.cell(0, rows * part / of - 1).y1};
}

void check(const RenderRequest& request) {
    const SceneRequest& scene = request.scene;
    check_camera(scene.camera, scene.size);
    if (scene.camera.orbit_about && !scene.camera.orbit_deg)
        refuse("⟨orbit-about⟩", "has no effect but with ⟨orbit⟩ or ⟨turntable⟩");
    check_moment(request.moment, scene.camera.exposure);
    check_samples(request.samples, scene.spectral.bins.has_value());
    if (request.crop) check_crop(*request.crop, scene.size, request.samples.noise.has_value());
    if (request.denoise) check_denoise(request);
    if (!scene.environment && scene.environment_rotate_deg != 0)
        refuse("⟨env-rotate⟩", "needs ⟨env⟩");
    if (!scene.environment && scene.environment_strength != 1)
        refuse("⟨env-strength⟩", "needs ⟨env⟩");
    if (scene.spectral.bins && scene.spectral.mode == SpectralMode::Rgb)
        refuse("⟨bins⟩", "needs wavelengths: leave out ⟨spectral⟩ rgb");
}

void check(const RenderOrder& order) {
    check(order.render);
    const RenderFiles files = files_of(order);
    // A state that stays keeps all.
    const bool keeps_all =
        files.state_stays || std::ranges::any_of(files.pictures, [](const auto& picture) {
            return !is_for_display(picture);
        });
    if (order.render.scene.spectral.bins && !keeps_all)
        refuse("⟨bins⟩", "needs an output that keeps them: ⟨output⟩ FILE.exr");
    if (!order.render.layers.empty() && !keeps_all)
        refuse("⟨aov⟩", "needs an output that keeps layers: ⟨output⟩ FILE.exr");
}

void check_sequence(const RenderOrder& order) {
    const SequenceRequest& sequence = order.sequence;
    const bool frames = !sequence.frames.empty();
    if (frames && order.render.moment.at) refuse("⟨frames⟩", "excludes ⟨at⟩");
    if (frames && sequence.turntable) refuse("⟨turntable⟩", "excludes ⟨frames⟩");
    if (sequence.turntable && order.render.scene.camera.orbit_deg)
        refuse("⟨turntable⟩", "excludes ⟨orbit⟩");
    if (sequence.sweep && frames) refuse("⟨sweep⟩", "excludes ⟨frames⟩");
    if (sequence.sweep && sequence.turntable) refuse("⟨sweep⟩", "excludes ⟨turntable⟩");
    if (sequence.sheet && !sequence.several())
        refuse("⟨sheet⟩", "needs ⟨frames⟩, ⟨turntable⟩ or ⟨sweep⟩");
}

}  // namespace petzval::apps
