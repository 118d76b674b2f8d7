// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/diffraction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/setup/lamps_in_view.h"
#include "camera/diffraction/diffraction_camera.h"
#include "camera/ray_bundle.h"
#include "camera/targets/make_target_camera.h"
#include "camera/waves/rays_and_pattern.h"
#include "core/light/small_features.h"

namespace petzval {
namespace {

/// Tangent of the angular radius up to which a lamp has a star: wider ones are met often enough,
/// and their spikes overlap.
constexpr float kMostWide = 0.05f;

/// Small lamps that shine into a camera.
std::vector<SmallFeature> star_lamps(const Scene& scene, const Pose& pose, const Bvh& bvh) {
    std::vector<SmallFeature> out = small_features_of(scene);
    std::erase_if(out, [&](const SmallFeature& thing) {
        const float away = thing.at_infinity ? 1 : (thing.centre - pose.origin).length();
        return !thing.is_lamp() || !(thing.reach_m > 0) || !(thing.reach_m < kMostWide * away) ||
               !shines_in(thing, pose, bvh);
    });
    return out;
}

}  // namespace

std::string DiffractionEffect::text() const {
    if (!has_iris) return "this camera has no iris, so that nothing is known of its diffraction";
    return fmt::format("diffraction leaves {:.0f} % of the contrast of lines a pixel wide{}",
                       100 * finest_contrast,
                       lamp ? ", and a small lamp that shines in gets a star" : "");
}

DiffractionEffect diffraction_effect(const View& view, V2i frame_px, const Scene& scene,
                                     const Bvh& bvh) {
    const auto camera = stop_camera(view.still);
    if (!camera) return {};
    return {true, finest_contrast(*camera, frame_px),
            !star_lamps(scene, pose_of(*camera), bvh).empty()};
}

std::optional<std::string> diffraction_doubt(const View& view, V2i frame_px, double focus_m) {
    constexpr double least = 0.01, most_cycles_per_mm = 100;
    const auto lens = std::dynamic_pointer_cast<const LensCamera>(view.still);
    if (!lens) return std::nullopt;
    const LensCameraInput& in = lens->input();
    // Fields of the axis, of 0.7 of the corner's, and of the corner.
    std::array<StopPoint, 8> points;
    points.fill({V2f(0.5f), V2f(0.f), kMiddle_nm});
    points[1].film = V2f(0.5f + 0.35f), points[2].film = V2f(1.f);
    const std::array<StopRay, 8> rays = rays_through(StopCamera(lens), points);
    std::vector<double> fields_deg{0};
    for (const StopRay& ray : {rays[1], rays[2]})
        if (ray.clear)
            fields_deg.push_back(std::acos(std::clamp(-ray.direction.normalized().z, -1., 1.)) *
                                 180 / std::numbers::pi);
    const std::array<WeighedWavelength, 3> light{
        {{kLineF_nm, 1 / 3.}, {kLineD_nm, 1 / 3.}, {kLineC_nm, 1 / 3.}}};
    const double cycles_per_mm = std::min(most_cycles_per_mm, frame_px.x / (2 * in.film_width_mm));
    const auto limits = diffraction_limits(
        *in.lens, in.film_mm, focus_m > 0 ? focus_m * 1e3 : INFINITY, fields_deg, light,
        cycles_per_mm,
        [&](double x, double y) { return double(in.iris.transmits(V2f(float(x), float(y)))); });
    if (!limits || !(limits->worst.contrast_error > least)) return std::nullopt;
    const RaysAndPattern& worst = limits->worst;
    return fmt::format(
        "diffraction is added to the lens's own errors, which exceeds their sum by "
        "waves: at {:.2g} degrees from the axis, contrast of {:.2g} cycles/mm is "
        "{:.2f}, and by waves {:.2f}",
        limits->field_deg, worst.cycles_per_mm, worst.by_rays_and_pattern, worst.by_waves);
}

void add_diffraction(const SceneRequest& asked, const RenderSetup* like,
                     const PreparedScene& prepared, View& view) {
    if (asked.camera.diffraction == DiffractionUse::Off) return;
    const bool same = like && like->view.diffraction && like->prepared.bvh == prepared.bvh &&
                      like->from.asked.size == asked.size &&
                      has_same_rays(*view.still, *like->view.still);
    if (same) {
        view.diffraction = like->view.diffraction;
    } else {
        const Scene& scene = *prepared.scene;
        if (!diffraction_effect(view, asked.size, scene, *prepared.bvh).matters()) return;
        const StopCamera camera = *stop_camera(view.still);
        FilmSpread spread(camera);
        LampImages lamps(*target_camera(view.still), asked.size,
                         star_lamps(scene, pose_of(camera), *prepared.bvh), spread);
        view.diffraction =
            std::make_shared<const Diffraction>(Diffraction{std::move(spread), std::move(lamps)});
    }
    view.camera = std::make_shared<DiffractionCamera>(std::move(view.camera), view.diffraction);
}

}  // namespace petzval
