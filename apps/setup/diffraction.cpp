// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/diffraction.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/setup/lamps_in_view.h"
#include "camera/diffraction/diffraction_camera.h"
#include "camera/targets/make_target_camera.h"

namespace petzval {
namespace {

/// Tangent of the angular radius up to which a lamp has a star: wider ones are met often enough,
/// and their spikes overlap.
constexpr float kMostWide = 0.05f;

/// Small lamps that shine into a camera.
std::vector<SmallFeature> star_lamps(std::span<const SmallFeature> things, const Pose& pose,
                                     const Bvh& bvh) {
    std::vector<SmallFeature> out;
    std::ranges::copy_if(things, std::back_inserter(out), [&](const SmallFeature& thing) {
        const float away = thing.at_infinity ? 1 : (thing.centre - pose.origin).length();
        return thing.is_lamp() && thing.reach_m > 0 && thing.reach_m < kMostWide * away &&
               shines_in(thing, pose, bvh);
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

DiffractionEffect diffraction_effect(const View& view, V2i frame_px,
                                     std::span<const SmallFeature> things, const Bvh& bvh) {
    const auto camera = stop_camera(view.still);
    if (!camera) return {};
    return {true, finest_contrast(*camera, frame_px),
            !star_lamps(things, pose_of(*camera), bvh).empty()};
}

std::shared_ptr<const Camera> with_diffraction(const SceneRequest& asked, const View& view,
                                               std::span<const SmallFeature> things,
                                               const Bvh& bvh) {
    if (asked.camera.diffraction == DiffractionUse::Off) return view.camera;
    if (!diffraction_effect(view, asked.size, things, bvh).matters()) return view.camera;
    const StopCamera camera = *stop_camera(view.still);
    FilmSpread spread(camera);
    LampImages images(*target_camera(view.still), asked.size,
                      star_lamps(things, pose_of(camera), bvh), spread);
    return std::make_shared<DiffractionCamera>(view.camera, std::move(spread), std::move(images));
}

}  // namespace petzval
