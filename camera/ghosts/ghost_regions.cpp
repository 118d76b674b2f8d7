// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_regions.h"

#include <algorithm>
#include <numeric>

#include "camera/ghosts/ghost_search.h"

namespace petzval::camera {
namespace {

constexpr size_t kMostLamps = 8;
/// Of the brightest lamp's light, below which a lamp is left to rays over all of the last surface.
constexpr double kDarkest = 1e-4;
/// Parts of the first surface that are looked at for all lamps and pairs: some seconds.
constexpr int kMostParts = 60'000;
/// Lamps' pairs that are searched at once, each as though the others before it took no parts.
constexpr size_t kAtOnce = 32;
/// Cells across the longer side of the film.
constexpr int kCells = 64;
constexpr size_t kMostInCell = 2048;
/// Share of the choice among pairs, and among regions of a pair, that is the same for all: their
/// light is known by few rays.
constexpr float kEvenly = 0.1f;
/// Share of the draws that goes to a rectangle so many times as long and as wide: what a region
/// misses lies close beside it.
constexpr float kWideShare = 0.1f, kWider = 8;

/// A lamp as the lens sees it; none where it lies in the lens or spreads too far for straight
/// lines.
std::optional<GhostLamp> lamp_of(const SmallFeature& f, const LensCamera& camera) {
    const Pose& pose = camera.pose();
    if (f.at_infinity) {
        if (!(f.radius_m < 0.5f)) return {};
        return GhostLamp{pose.local(f.centre), std::tan(double(f.reach_m)), true,
                         f.radiance * f.area_m2};
    }
    const V3d at_m = pose.local(f.centre - pose.origin);
    const double away_m = at_m.length(), reach_m = double(f.reach_m);
    if (!(reach_m < 0.5 * away_m)) return {};
    return GhostLamp{at_m * 1e3 + V3d(0, 0, camera.input().entrance_pupil_mm), reach_m * 1e3, false,
                     f.radiance * f.area_m2 / 2 / (away_m * away_m)};
}

}  // namespace

GhostRegions::GhostRegions(const GhostOptics& optics, std::span<const SmallFeature> things,
                           const RunTasks& run) {
    std::vector<GhostLamp> lamps;
    for (const SmallFeature& thing : things)
        if (thing.is_lamp())
            if (const auto lamp = lamp_of(thing, optics.camera()); lamp && lamp->nits_sr > 0)
                lamps.push_back(*lamp);
    std::ranges::stable_sort(lamps, std::greater(), &GhostLamp::nits_sr);
    lamps.resize(std::min(lamps.size(), kMostLamps));
    std::erase_if(lamps, [most = lamps.empty() ? 0 : lamps[0].nits_sr](const GhostLamp& lamp) {
        return lamp.nits_sr < kDarkest * most;
    });
    if (lamps.empty()) return;
    search(optics, lamps, run);
    film_mm_ = V2f(float(optics.camera().input().film_width_mm),
                   float(optics.camera().input().film_height_mm));
    const float longer = std::max(film_mm_.x, film_mm_.y);
    const auto count = [&](float mm) {
        return std::max(1, int(std::lround(kCells * mm / longer)));
    };
    cells_ = {count(film_mm_.x), count(film_mm_.y)};
    list_regions(run);
}

void GhostRegions::search(const GhostOptics& optics, std::span<const GhostLamp> lamps,
                          const RunTasks& run) {
    const GhostSearch search(optics);
    // The pairs that reflect most come first, as the search must end.
    std::vector<uint32_t> pairs(optics.pairs().size());
    std::iota(pairs.begin(), pairs.end(), 0u);
    std::ranges::stable_sort(pairs, std::greater(),
                             [&](uint32_t k) { return optics.reflects(optics.pairs()[k]); });
    const size_t all = lamps.size() * pairs.size();
    int left = kMostParts;
    for (size_t first = 0; first < all; first += kAtOnce) {
        const int most = left;
        const auto find = [&](size_t i, int most_parts) {
            return search.find(pairs[(first + i) % pairs.size()], lamps[(first + i) / pairs.size()],
                               most_parts);
        };
        std::vector<GhostSearch::Found> found(std::min(kAtOnce, all - first));
        run(found.size(), [&](size_t i) { found[i] = find(i, most); });
        for (size_t i = 0; i < found.size(); ++i) {
            if (most > 0 && left < most && found[i].parts >= left) found[i] = find(i, left);
            left -= found[i].parts;
            std::ranges::copy_if(found[i].regions, std::back_inserter(regions_),
                                 [](const GhostRegion& r) { return r.light > 0; });
        }
    }
}

template <class F>
void GhostRegions::each_cell(const GhostRegion& r, const F& f) const {
    // Edges of the region in cells, from the film's corner.
    const auto low = (r.film_low / film_mm_ + V2f(0.5f)) * V2f(cells_),
               high = (r.film_high / film_mm_ + V2f(0.5f)) * V2f(cells_);
    const auto first = [](float at, int cells) {
        return int(std::clamp(at, 0.f, float(cells - 1)));
    };
    const auto share = [](float from, float to, int cell) {
        return std::max(0.f, std::min(to, float(cell + 1)) - std::max(from, float(cell)));
    };
    for (int y = first(low.y, cells_.y); y <= first(high.y, cells_.y); ++y)
        for (int x = first(low.x, cells_.x); x <= first(high.x, cells_.x); ++x)
            f(size_t(y) * size_t(cells_.x) + size_t(x),
              share(low.x, high.x, x) * share(low.y, high.y, y));
}

void GhostRegions::list_regions(const RunTasks& run) {
    struct Member {
        uint32_t region;
        float light;
    };
    std::vector<std::vector<Member>> lists(size_t(cells_.x) * size_t(cells_.y));
    for (uint32_t k = 0; k < regions_.size(); ++k)
        each_cell(regions_[k], [&](size_t cell, float share) {
            lists[cell].push_back({k, regions_[k].light * share});
        });
    const auto pair_of = [&](const Member& m) { return regions_[m.region].pair; };
    run(lists.size(), [&](size_t cell) {
        std::vector<Member>& list = lists[cell];
        std::ranges::stable_sort(list, std::greater(), &Member::light);
        list.resize(std::min(list.size(), kMostInCell));
        std::ranges::stable_sort(list, {}, pair_of);
    });
    const auto first_group = [&] { return groups_.begin() + cells_begin_.back(); };
    cells_begin_.push_back(0);
    for (const std::vector<Member>& list : lists) {
        float all = 0, sum = 0;
        for (const Member& m : list) all += m.light;
        for (size_t i = 0; i < list.size(); ++i) {
            const auto at = uint32_t(members_.size());
            if (i == 0 || pair_of(list[i]) != pair_of(list[i - 1]))
                groups_.push_back({pair_of(list[i]), 0, at, at});
            sum += list[i].light;
            members_.push_back(list[i].region);
            groups_.back().end = at + 1;
            groups_.back().up_to = all > 0 ? sum / all : 1;
        }
        const auto count = float(groups_.end() - first_group());
        float number = 0;
        for (auto group = first_group(); group != groups_.end(); ++group)
            group->up_to = (1 - kEvenly) * group->up_to + kEvenly * (++number / count);
        cells_begin_.push_back(uint32_t(groups_.size()));
    }
}

auto GhostRegions::groups_at(V2f film_mm) const -> std::span<const Group> {
    if (regions_.empty()) return {};
    const auto cell = [](float mm, float size_mm, int cells) {
        return size_t(std::clamp(int((mm / size_mm + 0.5f) * float(cells)), 0, cells - 1));
    };
    const size_t at = cell(film_mm.y, film_mm_.y, cells_.y) * size_t(cells_.x) +
                      cell(film_mm.x, film_mm_.x, cells_.x);
    return std::span(groups_).subspan(cells_begin_[at], cells_begin_[at + 1] - cells_begin_[at]);
}

auto GhostRegions::serving(const Group& group, V2f film_mm) const -> Serving {
    Serving out;
    for (uint32_t i = group.first; i < group.end; ++i)
        if (const GhostRegion& r = regions_[members_[i]]; r.serves(film_mm))
            out.light += r.light, ++out.count;
    return out;
}

float GhostRegions::Serving::chance(const GhostRegion& r) const {
    return (1 - kEvenly) * r.light / light + kEvenly / count;
}

auto GhostRegions::picked(std::span<const Group> groups, float& pick) -> const Group& {
    auto group = std::ranges::upper_bound(groups, pick, {}, &Group::up_to);
    if (group == groups.end()) --group;
    const float before = group == groups.begin() ? 0 : (group - 1)->up_to;
    pick = (pick - before) / (group->up_to - before);
    return *group;
}

auto GhostRegions::group_of(std::span<const Group> groups, uint32_t pair)
    -> std::pair<const Group*, float> {
    const auto group = std::ranges::lower_bound(groups, pair, {}, &Group::pair);
    if (group == groups.end() || group->pair != pair) return {nullptr, 0.f};
    return {&*group, group->up_to - (group == groups.begin() ? 0 : (group - 1)->up_to)};
}

uint32_t GhostRegions::pair(V2f film_mm, float pick) const {
    return picked(groups_at(film_mm), pick).pair;
}

float GhostRegions::chance(V2f film_mm, uint32_t pair) const {
    return group_of(groups_at(film_mm), pair).second;
}

auto GhostRegions::draw(V2f film_mm, float wave, float pick, V2f u) const
    -> std::optional<GhostDraw> {
    const auto groups = groups_at(film_mm);
    if (groups.empty()) return {};
    const Group& group = picked(groups, pick);
    float left = pick;
    const Serving all = serving(group, film_mm);
    const GhostRegion* chosen = nullptr;
    for (uint32_t i = group.first; i < group.end; ++i) {
        const GhostRegion& r = regions_[members_[i]];
        if (!r.serves(film_mm)) continue;
        chosen = &r;
        const float chance = all.chance(r);
        if (left < chance) break;
        left -= chance;
    }
    if (!chosen) return {};
    const bool wide = u.x < kWideShare;
    const float x = wide ? u.x / kWideShare : (u.x - kWideShare) / (1 - kWideShare);
    return GhostDraw{chosen->pair, chosen->at(film_mm, wave, {x, u.y}, wide ? kWider : 1.f)};
}

float GhostRegions::density(V2f film_mm, float wave, const GhostDraw& drawn) const {
    const auto [group, chance] = group_of(groups_at(film_mm), drawn.pair);
    if (!group) return 0;
    const Serving all = serving(*group, film_mm);
    float sum = 0;
    for (uint32_t i = group->first; i < group->end; ++i) {
        const GhostRegion& r = regions_[members_[i]];
        if (!r.serves(film_mm)) continue;
        if (!r.contains(film_mm, wave, drawn.rear_mm, kWider)) continue;
        const bool within = r.contains(film_mm, wave, drawn.rear_mm);
        sum += all.chance(r) / r.area_mm2() *
               (kWideShare / (kWider * kWider) + (within ? 1 - kWideShare : 0.f));
    }
    return sum * chance;
}

}  // namespace petzval::camera
