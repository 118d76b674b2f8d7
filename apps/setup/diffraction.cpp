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

namespace petzval::apps {
namespace {

/// Tangent of the angular radius up to which a lamp has a star: wider ones are met often enough,
/// and their spikes overlap.
constexpr float kMostWide = 0.05f;

/// Small lamps that shine into a camera.
std::vector<SmallFeature> star_lamps(const Scene& scene, const camera::Pose& pose, const Bvh& bvh) {
    std::vector<SmallFeature> out = small_features_of(scene);
    std::erase_if(out, [&](const SmallFeature& thing) {
        const float away = thing.at_infinity ? 1 : (thing.centre - pose.origin).length();
        return !thing.is_lamp() || !(thing.reach_m > 0) || !(thing.reach_m < kMostWide * away) ||
               !shines_in(thing, pose, bvh);
    });
    return out;
}

/// Errors of contrast on the axis, at 0.7 of the corner's field, and in the corner.
std::optional<DiffractionEffect::Errors> errors_of(
    const std::shared_ptr<const camera::LensCamera>& lens, V2i frame_px, double focus_m) {
    constexpr double most_cycles_per_mm = 100;
    const std::array<camera::WeighedWavelength, 3> light{
        {{kLineF_nm, 1 / 3.}, {kLineD_nm, 1 / 3.}, {kLineC_nm, 1 / 3.}}};
    const camera::LensCameraInput& in = lens->input();
    std::array<camera::StopPoint, 8> points;
    points.fill({V2f(0.5f), V2f(0.f), camera::kMiddle_nm});
    points[1].film = V2f(0.5f + 0.35f), points[2].film = V2f(1.f);
    const std::array<camera::StopRay, 8> rays =
        camera::rays_through(camera::StopCamera(lens), points);
    std::optional<DiffractionEffect::Errors> out;
    for (const camera::StopRay& ray : {rays[0], rays[1], rays[2]}) {
        if (!ray.clear) continue;
        const double ahead = std::clamp(-ray.direction.normalized().z, -1., 1.);
        const double field_deg = std::acos(ahead) * 180 / std::numbers::pi;
        const auto limits = camera::diffraction_limits(
            *in.lens, in.film_mm, focus_m > 0 ? focus_m * 1e3 : INFINITY, {&field_deg, 1}, light,
            std::min(most_cycles_per_mm, frame_px.x / (2 * in.film_width_mm)),
            [&](double x, double y) { return double(in.iris.transmits(V2f(float(x), float(y)))); });
        if (!limits) continue;
        if (!out) out.emplace();
        out->with = std::max(out->with, limits->worst.contrast_error);
        out->without = std::max(out->without, limits->worst.error_of_rays);
    }
    return out;
}

/// Targets that are not sharp; nullptr: there are none.
std::shared_ptr<const camera::TargetGrid> blurred(const camera::TargetGrid& all) {
    auto out = std::make_shared<camera::TargetGrid>(all);
    bool any = false;
    for (camera::TargetCell& cell : out->lists) {
        std::erase_if(cell.targets, [](const camera::ListedTarget& t) { return t.is_sharp; });
        float sum = 0;
        for (const camera::ListedTarget& t : cell.targets) sum += t.chance;
        for (camera::ListedTarget& t : cell.targets) t.chance /= sum;
        any |= !cell.empty();
    }
    return any ? out : nullptr;
}

}  // namespace

std::string DiffractionEffect::text() const {
    if (!has_iris) return "this camera has no iris, so that nothing is known of its diffraction";
    std::string out = changes() ? fmt::format("lines a pixel wide keep {:.0f} % of their contrast",
                                              100 * finest_contrast)
                                : "lines a pixel wide keep their contrast";
    if (!lamps.empty()) out += ", and a small lamp that shines in gets a star";
    if (errors && changes())
        out += fmt::format(
            "; added to the lens's own errors, contrast is off by {:.2f} in the worst of three "
            "places, and without diffraction by {:.2f}",
            errors->with, errors->without);
    return out;
}

DiffractionEffect diffraction_effect(const View& view, V2i frame_px, double focus_m,
                                     const PreparedScene& prepared) {
    const auto camera = camera::stop_camera(view.still);
    if (!camera) return {};
    DiffractionEffect out{true, camera::finest_contrast(*camera, frame_px),
                          star_lamps(*prepared.scene, camera::pose_of(*camera), *prepared.bvh)};
    if (const auto* lens = std::get_if<std::shared_ptr<const camera::LensCamera>>(&*camera))
        out.errors = errors_of(*lens, frame_px, focus_m);
    return out;
}

std::optional<std::string> add_diffraction(const SceneRequest& asked, double focus_m,
                                           const RenderSetup* like, const PreparedScene& prepared,
                                           View& view) {
    if (asked.camera.diffraction == DiffractionUse::Off) return std::nullopt;
    const bool same = like && like->from.asked.camera.diffraction == DiffractionUse::Auto &&
                      like->prepared.bvh == prepared.bvh && like->from.asked.size == asked.size &&
                      camera::has_same_rays(*view.still, *like->view.still);
    std::optional<std::string> remark;
    if (same) {
        view.diffraction = like->view.diffraction;
    } else {
        const DiffractionEffect effect = diffraction_effect(view, asked.size, focus_m, prepared);
        if (effect.has_doubt())
            remark = fmt::format("diffraction: {}{}", effect.text(),
                                 effect.matters() ? "" : ": it is left out");
        if (!effect.matters()) return remark;
        camera::FilmSpread spread(*camera::stop_camera(view.still));
        camera::LampImages lamps(*camera::target_camera(view.still), asked.size, effect.lamps,
                                 spread);
        const float shared = camera::shared_frequency(spread, asked.size);
        view.diffraction = std::make_shared<const camera::Diffraction>(
            camera::Diffraction{std::move(spread), std::move(lamps), shared});
    }
    if (!view.diffraction) return remark;
    std::shared_ptr<const camera::Camera> far = view.still;
    if (view.targets) {
        auto aims = camera::target_camera(view.still);
        aims->set_targets(blurred(*view.targets));
        far = std::move(aims);
    }
    view.camera = std::make_shared<camera::DiffractionCamera>(std::move(view.camera),
                                                              std::move(far), view.diffraction);
    return remark;
}

}  // namespace petzval::apps
