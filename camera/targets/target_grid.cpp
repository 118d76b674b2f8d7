// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/target_grid.h"

#include <algorithm>
#include <cmath>

#include "camera/setup/film_region.h"
#include "core/sampling/prepass_seed.h"

namespace petzval {
namespace {

constexpr int kCell_px = 16;
/// Things of a cell that are tried, brightest first, and that may be found.
constexpr size_t kMostTried = 32, kMostFound = 20;
/// Rays of a cell that tell which things it may see, and the margin for what lies between them.
constexpr int kRays = 64;
constexpr float kMargin = 0.4f;
constexpr size_t kMostListed = 16;
/// Share of a pixel's ordinary rays that may pass a target: where they are more, they do as well.
constexpr double kMostMet = 0.25;
/// Share of the light of a cell's brightest target below which another is left out.
constexpr double kLeastLight = 1e-3;

/// Disc that faces a camera at `eye`.
Target target_of(const SmallFeature& lamp, const V3f& eye) {
    if (lamp.at_infinity) return {lamp.centre, lamp.centre, std::tan(lamp.reach_m), true};
    return {lamp.centre, unit(lamp.centre - eye), lamp.reach_m, false};
}

/// A lamp, and what the camera makes of it once a cell asks for it.
struct LampToTry {
    SmallFeature feature;
    uint32_t number = 0;  ///< of its target
    std::optional<PreparedTarget> ready{};
    bool hopeless = false;
};

bool may_be_target(const SmallFeature& feature) {
    return feature.is_lamp() && feature.reach_m > 0 && std::isfinite(feature.reach_m) &&
           std::isfinite(feature.radiance) && !(feature.at_infinity && feature.reach_m > 0.5f);
}

}  // namespace

std::shared_ptr<const TargetGrid> find_targets(const TargetCamera& camera, V2i size_px,
                                               std::span<const SmallFeature> features) {
    if (size_px.x < kCell_px || size_px.y < kCell_px) return nullptr;
    std::vector<LampToTry> lamps;
    for (const SmallFeature& feature : features)
        if (may_be_target(feature)) lamps.push_back({feature});
    if (lamps.empty()) return nullptr;
    std::stable_sort(lamps.begin(), lamps.end(), [](const LampToTry& a, const LampToTry& b) {
        return a.feature.radiance > b.feature.radiance;
    });
    auto out = std::make_shared<TargetGrid>();
    // Cells are no smaller than that, so that a pilot of each stays below a quarter of a sample.
    out->cells = {size_px.x / kCell_px, size_px.y / kCell_px};
    bool any = false;
    for (int j = 0; j < out->cells.y; ++j)
        for (int i = 0; i < out->cells.x; ++i) {
            std::vector<ListedTarget>& list = out->lists.emplace_back();
            const FilmCell place = out->cell(i, j, size_px);
            const RayBundle bundle =
                bundle_of(camera, place, number_of(PrepassSeed::TargetCells), {i, j}, kRays);
            size_t tried = 0;
            for (LampToTry& lamp : lamps) {
                if (lamp.hopeless || !passes(bundle, lamp.feature, kMargin)) continue;
                if (!lamp.ready) {
                    const Target target = target_of(lamp.feature, bundle.rays[0].origin);
                    lamp.ready = camera.prepared(target);
                    lamp.hopeless = !lamp.ready;
                    if (lamp.hopeless) continue;
                    lamp.number = static_cast<uint32_t>(out->targets.size());
                    out->targets.push_back(target);
                }
                if (list.size() == kMostFound || ++tried > kMostTried) break;
                auto target = camera.listed(*lamp.ready, place);
                if (!target || !(target->met < kMostMet)) continue;
                target->chance = target->met * static_cast<float>(lamp.feature.radiance);
                target->number = lamp.number;
                list.push_back(*std::move(target));
            }
            std::stable_sort(list.begin(), list.end(),
                             [](const auto& a, const auto& b) { return a.chance > b.chance; });
            if (list.size() > kMostListed) list.erase(list.begin() + kMostListed, list.end());
            std::erase_if(list, [most = list.empty() ? 0.f : list[0].chance](const auto& t) {
                return !(t.chance > float(kLeastLight) * most);
            });
            float sum = 0;
            for (const ListedTarget& t : list) sum += t.chance;
            for (ListedTarget& t : list) t.chance /= sum;
            any = any || !list.empty();
        }
    return any ? out : nullptr;
}

}  // namespace petzval
