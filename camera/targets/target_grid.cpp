// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/target_grid.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "camera/setup/film_region.h"
#include "core/sampling/prepass_seed.h"

namespace petzval::camera {
namespace {

/// Side of a cell, so that a pilot of each stays below a quarter of a sample; in small frames it is
/// less, as a map of the lens is good for a small part of the film. In large ones more would find
/// nothing more, and a search takes as long as a few samples of all pixels.
constexpr int kCell_px = 16, kLeastCell_px = 2, kFewestCells = 20, kMostCells = 48;
/// Rays of a cell that tell which things it may see, and the margin for what lies between them.
constexpr int kRays = 64;
constexpr float kMargin = 0.4f;
/// Things of a cell that are tried, brightest first.
constexpr size_t kMostTried = 3 * TargetCell::kMostTargets;
/// Share of a pixel's ordinary rays that may pass a target: where they are more, they do as well.
constexpr double kMostMet = 0.25;
/// Share of the light of a cell's brightest target below which another is left out.
constexpr double kLeastLight = 1e-3;

bool may_be_target(const SmallFeature& feature) {
    return feature.is_lamp() && feature.reach_m > 0 && std::isfinite(feature.reach_m) &&
           std::isfinite(feature.radiance) && !(feature.at_infinity && feature.reach_m > 0.5f);
}

/// Part of the film that the pixels of a cell see, in a frame of so many: half of a filter's reach
/// holds 93 % of its points, and costs less time than all of it.
FilmCell reached_by(const FilmCell& cell, V2i size_px) {
    const V2f reach = V2f(kFilterReach_px / 2) / V2f(size_px);
    return {cell.first - reach, cell.last + reach};
}

/// The targets of a cell, by what each is expected to add to a pixel. lamps: brightest first, and
/// targets: what they are as such.
TargetCell listed_in(const TargetCamera& camera, const FilmCell& pixels, V2i number, V2i size_px,
                     std::span<const SmallFeature> lamps, std::span<const Target> targets) {
    const FilmCell place = reached_by(pixels, size_px);
    const RayBundle bundle =
        bundle_of(camera, place, number_of(PrepassSeed::TargetCells), number, kRays);
    TargetCell cell;
    std::vector<ListedTarget>& list = cell.targets;
    size_t tried = 0;
    for (size_t n = 0; n < lamps.size() && tried < kMostTried; ++n) {
        if (!passes(bundle, lamps[n], kMargin)) continue;
        if (tried++ == 0) cell.map = camera.map(place);
        if (!cell.map) break;
        auto target = camera.listed(targets[n], *cell.map, size_px);
        if (!target || !(target->met < kMostMet)) continue;
        if (!(target->seen_from.within(pixels).area() > 0)) continue;
        target->chance = target->met * static_cast<float>(lamps[n].radiance);
        target->number = static_cast<uint32_t>(n);
        list.push_back(*std::move(target));
    }
    std::stable_sort(list.begin(), list.end(),
                     [](const auto& a, const auto& b) { return a.chance > b.chance; });
    if (list.size() > TargetCell::kMostTargets)
        list.erase(list.begin() + TargetCell::kMostTargets, list.end());
    std::erase_if(list, [brightest = list.empty() ? 0.f : list[0].chance](const auto& t) {
        return !(t.chance > float(kLeastLight) * brightest);
    });
    list.shrink_to_fit();
    for (const ListedTarget& t : list) cell.light_nits += t.chance;
    for (ListedTarget& t : list) t.chance /= cell.light_nits;
    if (list.empty()) cell.map = nullptr;
    return cell;
}

}  // namespace

Target target_of(const SmallFeature& lamp) {
    return {lamp.centre, lamp.at_infinity ? std::tan(lamp.reach_m) : lamp.reach_m, lamp.at_infinity,
            lamp.image};
}

std::shared_ptr<const TargetGrid> find_targets(const TargetCamera& camera, V2i size_px,
                                               std::span<const SmallFeature> features,
                                               const RunTasks& run) {
    if (size_px.x < kCell_px || size_px.y < kCell_px) return nullptr;
    std::vector<SmallFeature> lamps;
    std::copy_if(features.begin(), features.end(), std::back_inserter(lamps), may_be_target);
    if (lamps.empty()) return nullptr;
    std::stable_sort(lamps.begin(), lamps.end(),
                     [](const auto& a, const auto& b) { return a.radiance > b.radiance; });
    auto out = std::make_shared<TargetGrid>();
    for (const SmallFeature& lamp : lamps) out->targets.push_back(target_of(lamp));
    const auto cells = [](int px) {
        return std::clamp(px / kCell_px, std::min(px / kLeastCell_px, kFewestCells), kMostCells);
    };
    out->cells = {cells(size_px.x), cells(size_px.y)};
    out->lists.resize(static_cast<size_t>(out->cells.x) * static_cast<size_t>(out->cells.y));
    run_cells(run, out->cells, [&](size_t n, V2i cell) {
        out->lists[n] =
            listed_in(camera, out->cell(cell.x, cell.y), cell, size_px, lamps, out->targets);
    });
    const bool any = std::any_of(out->lists.begin(), out->lists.end(),
                                 [](const TargetCell& cell) { return !cell.empty(); });
    return any ? out : nullptr;
}

}  // namespace petzval::camera
