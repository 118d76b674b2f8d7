// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/ghosts.h"

#include "apps/setup/lamps_in_view.h"
#include "camera/ghosts/ghost_camera.h"
#include "io/base/error.h"

namespace petzval {
namespace {

std::shared_ptr<const LensCamera> traced_lens(const View& view) {
    return std::dynamic_pointer_cast<const LensCamera>(view.still);
}

}  // namespace

std::shared_ptr<const Camera> with_ghosts(const CameraRequest& asked, const View& view,
                                          const Scene& scene, const Bvh& bvh) {
    const auto lens = traced_lens(view);
    const bool only = asked.ghosts == GhostUse::Only;
    if (!lens || asked.ghosts == GhostUse::Off) return view.camera;
    if (asked.coating == Coating::Ideal && !only) return view.camera;
    GhostOptics optics(lens);
    if (optics.pairs().empty()) {
        if (!only) return view.camera;
        throw ArgumentError("⟨ghosts⟩ only", "",
                            "shows light that two surfaces of the lens reflect, and here none "
                            "do: give ⟨coating⟩ year or another, and a lens of more surfaces");
    }
    // A lamp that is hidden from the lens, or behind it, may show a part: it comes last.
    constexpr double kHidden = 0.01;
    std::vector<SmallFeature> things = small_features_of(scene);
    for (SmallFeature& thing : things)
        if (!shines_in(thing, lens->pose(), bvh)) thing.radiance *= kHidden;
    GhostRegions regions(optics, things);
    return std::make_shared<GhostCamera>(only ? nullptr : view.camera, std::move(optics),
                                         std::move(regions));
}

std::optional<std::string> ghost_remark(const CameraRequest& asked, const View& view,
                                        std::span<const SmallFeature> things, const Bvh& bvh) {
    const auto lens = traced_lens(view);
    if (!lens || asked.coating != Coating::Ideal || asked.ghosts == GhostUse::Off) return {};
    for (const SmallFeature& thing : things)
        if (thing.is_lamp() && shines_in(thing, lens->pose(), bvh))
            return "a lamp shines into the lens, whose surfaces reflect nothing here: ⟨coating⟩ "
                   "year shows its ghosts";
    return {};
}

}  // namespace petzval
