// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/diffraction.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/setup/lamps_in_view.h"
#include "camera/diffraction/diffraction_camera.h"
#include "camera/targets/make_target_camera.h"

namespace petzval {

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
    const bool lamp = std::ranges::any_of(things, [&](const SmallFeature& thing) {
        return thing.is_lamp() && shines_in(thing, pose_of(*camera), bvh);
    });
    return {true, finest_contrast(*camera, frame_px), lamp};
}

std::shared_ptr<const Camera> with_diffraction(const SceneRequest& asked, const View& view,
                                               std::span<const SmallFeature> things,
                                               const Bvh& bvh) {
    if (asked.camera.diffraction == DiffractionUse::Off) return view.camera;
    if (!diffraction_effect(view, asked.size, things, bvh).matters()) return view.camera;
    const StopCamera camera = *stop_camera(view.still);
    std::vector<SmallFeature> lamps;
    std::ranges::copy_if(things, std::back_inserter(lamps), [&](const SmallFeature& thing) {
        return thing.is_lamp() && shines_in(thing, pose_of(camera), bvh);
    });
    FilmSpread spread(camera);
    LampImages images(*target_camera(view.still), asked.size, lamps, spread);
    return std::make_shared<DiffractionCamera>(view.camera, std::move(spread), std::move(images));
}

}  // namespace petzval
