// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/ghosts.h"

#include <algorithm>

#include "apps/setup/lamps_in_view.h"
#include "camera/ghosts/ghost_camera.h"
#include "integrator/render/executor.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

std::shared_ptr<const camera::LensCamera> traced_lens(const View& view) {
    return std::dynamic_pointer_cast<const camera::LensCamera>(view.still);
}

std::shared_ptr<const camera::GhostDraws> ghost_draws(const camera::GhostOptics& optics,
                                                      const PreparedScene& prepared,
                                                      const std::function<void()>& next_step) {
    // A lamp that is hidden from the lens, or behind it, may show a part: it comes last.
    constexpr double kHidden = 0.01;
    std::vector<SmallFeature> things = small_features_of(*prepared.scene);
    for (SmallFeature& thing : things)
        if (!shines_in(thing, optics.camera().pose(), *prepared.bvh)) thing.radiance *= kHidden;
    const auto run = integrator::run_here(next_step);
    return std::make_shared<const camera::GhostDraws>(
        optics, camera::GhostRegions(optics, things, run), run);
}

}  // namespace

void add_ghosts(const CameraRequest& asked, const RenderSetup* like, const PreparedScene& prepared,
                const std::function<void()>& next_step, View& view) {
    const auto lens = traced_lens(view);
    const bool only = asked.ghosts == GhostUse::Only;
    if (!lens || asked.ghosts == GhostUse::Off) return;
    if (asked.coating == camera::Coating::Ideal && !only) return;
    camera::GhostOptics optics(lens);
    if (optics.pairs().empty()) {
        if (!only) return;
        throw io::ArgumentError("⟨ghosts⟩ only", "",
                                "shows light that two surfaces of the lens reflect, and here none "
                                "do: give ⟨coating⟩=year or another, and a lens of more surfaces");
    }
    const bool same = like && like->view.ghosts && like->prepared.bvh == prepared.bvh &&
                      like->view.ghosts->are_of(optics);
    view.ghosts = same ? like->view.ghosts : ghost_draws(optics, prepared, next_step);
    view.camera = std::make_shared<camera::GhostCamera>(only ? nullptr : std::move(view.camera),
                                                        std::move(optics), view.ghosts);
}

size_t lamps_into_lens(const View& view, std::span<const SmallFeature> things, const Bvh& bvh) {
    const auto lens = traced_lens(view);
    if (!lens) return 0;
    return static_cast<size_t>(std::ranges::count_if(things, [&](const SmallFeature& thing) {
        return thing.is_lamp() && shines_in(thing, lens->pose(), bvh);
    }));
}

std::optional<std::string> ghost_remark(const CameraRequest& asked, const View& view,
                                        std::span<const SmallFeature> things, const Bvh& bvh) {
    if (asked.coating != camera::Coating::Ideal || asked.ghosts == GhostUse::Off) return {};
    if (lamps_into_lens(view, things, bvh) == 0) return {};
    return "a lamp shines into the lens, whose surfaces reflect nothing here: ⟨coating⟩=year shows "
           "its ghosts";
}

}  // namespace petzval::apps
