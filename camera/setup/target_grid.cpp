// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/target_grid.h"

#include <algorithm>
#include <cmath>

#include "camera/setup/film_region.h"

namespace petzval {
namespace {

constexpr int kCell_px = 16;
/// Things of a cell that are tried, brightest first, and rays that are aimed at each: with those of
/// the cell's bundle a quarter of a ray for each pixel.
constexpr size_t kMostTried = 12;
constexpr uint32_t kTries = 4;
constexpr size_t kMostListed = 8;
/// Share of a pixel's ordinary rays that may pass a target: where they are more, they do as well.
constexpr double kMostMet = 0.25;
/// Share of the light of a cell's brightest target below which another is left out.
constexpr double kLeastLight = 1e-3;

/// Disc that faces a camera at `eye`.
Target target_of(const Thing& lamp, const V3f& eye) {
    if (lamp.at_infinity) return {lamp.centre, lamp.centre, std::tan(lamp.reach_m), true};
    return {lamp.centre, unit(lamp.centre - eye), lamp.reach_m, false};
}

/// Share of a cell's ordinary rays that pass a target: by the densities of rays that are aimed.
double met_share(const Camera& camera, const Rect& cell, V2i size_px, const Target& target) {
    const ListedTarget alone{target, 1};
    double sum = 0;
    for (uint32_t i = 0; i < kTries; ++i) {
        const Sampler sampler(SamplerKind::Owen, 2, {cell.x0, cell.y0, i});
        const V2f within = sampler.get2(Dim::Film);
        const V2f film = V2f(float(cell.x0) + within.x * float(cell.width()),
                             float(cell.y0) + within.y * float(cell.height())) /
                         V2f(size_px);
        const CameraSample paths = camera.aimed({film, sampler}, Bands::rgb(), {&alone, 1});
        if (paths.empty()) continue;
        // Of the two densities: a ray that is met by chance has 1, one that is aimed 1 / met.
        const double share = double(paths[0].share);
        sum += std::min(1., share / (1 - share)) / kTries;
    }
    return sum;
}

bool may_be_target(const Thing& thing) {
    return thing.is_lamp() && thing.reach_m > 0 && std::isfinite(thing.reach_m) &&
           std::isfinite(thing.radiance) && !(thing.at_infinity && thing.reach_m > 0.5f);
}

}  // namespace

std::shared_ptr<const TargetGrid> find_targets(const Camera& camera, V2i size_px,
                                               std::span<const Thing> things) {
    if (!camera.aims()) return nullptr;
    std::vector<Thing> lamps;
    std::copy_if(things.begin(), things.end(), std::back_inserter(lamps), may_be_target);
    if (lamps.empty()) return nullptr;
    std::stable_sort(lamps.begin(), lamps.end(),
                     [](const Thing& a, const Thing& b) { return a.radiance > b.radiance; });
    auto out = std::make_shared<TargetGrid>();
    out->cells = {(size_px.x + kCell_px - 1) / kCell_px, (size_px.y + kCell_px - 1) / kCell_px};
    bool any = false;
    for (int j = 0; j < out->cells.y; ++j)
        for (int i = 0; i < out->cells.x; ++i) {
            const Rect cell{size_px.x * i / out->cells.x, size_px.y * j / out->cells.y,
                            size_px.x * (i + 1) / out->cells.x, size_px.y * (j + 1) / out->cells.y};
            std::vector<ListedTarget>& list = out->lists.emplace_back();
            const RayBundle bundle = bundle_of(camera, size_px, cell);
            size_t tried = 0;
            for (const Thing& lamp : lamps) {
                if (!passes(bundle, lamp)) continue;
                if (++tried > kMostTried) break;
                const Target target = target_of(lamp, bundle.rays[0].origin);
                const double met = met_share(camera, cell, size_px, target);
                if (met > 0 && met < kMostMet)
                    list.push_back({target, static_cast<float>(met * lamp.radiance)});
            }
            std::stable_sort(list.begin(), list.end(),
                             [](const auto& a, const auto& b) { return a.chance > b.chance; });
            if (list.size() > kMostListed) list.resize(kMostListed);
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
