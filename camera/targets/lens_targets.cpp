// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/lens_targets.h"

#include <algorithm>
#include <cmath>

#include "camera/lens/trace.h"
#include "camera/targets/lens_target_planes.h"
#include "core/sampling/warp.h"
#include "core/spectrum/glass.h"

namespace petzval {
namespace {

/// Distance from the chosen point at which a ray is there, in radii of the target; what floats
/// leave of a distance comes to it.
constexpr float kTolerance = 1e-3f, kRounding = 3e-7f;
}  // namespace

/// Distinct directions from which rays pass one point, by the start that led to each.
struct LensTargets::Ways {
    int count = 0;
    std::array<f8, ListedTarget::kMostStarts> l{}, m{};
    std::array<f8, ListedTarget::kMostStarts> light{};  ///< in any unit; 0: no way, or known before
    f8 all{};                                           ///< their light
};

LensTargets::LensTargets(const Lens& lens, const RayAimer& aimer, double pupil_mm,
                         double stop_reach_mm, double iris_mm2)
    : lens_(lens),
      aimer_(aimer),
      pupil_mm_(pupil_mm),
      stop_reach_mm_(stop_reach_mm),
      iris_mm2_(iris_mm2) {
    const LensIndices<f8> line_d = lens.exact_indices(splat8(static_cast<float>(kLineD_nm)));
    const float stretch_mm2 =
        aimer.cross<f8>(PlanePoint<f8>(V2f(0.f)), f8{}, f8{}, line_d).stretch_mm2()[0];
    cosine_reach_ = static_cast<float>(stop_reach_mm) / std::sqrt(stretch_mm2);
}

auto LensTargets::goals(const std::array<TargetList, 8>& lists,
                        const std::array<int, 8>& which) const -> Goals {
    Goals out;
    for (int i = 0; i < 8; ++i) {
        const auto lane = static_cast<size_t>(i);
        if (which[lane] < 0 || which[lane] >= static_cast<int>(lists[lane].size())) continue;
        const ListedTarget& listed = lists[lane][static_cast<size_t>(which[lane])];
        const LocalTarget& target = listed.target;
        const auto put = [i](Vec3<f8>& to, const V3d& v) {
            to.x[i] = static_cast<float>(v.x), to.y[i] = static_cast<float>(v.y);
            to.z[i] = static_cast<float>(v.z);
        };
        put(out.normal, target.normal);
        put(out.across, target.across);
        put(out.up, target.up);
        put(out.centre,
            target.at_infinity ? target.centre : 1e3 * target.centre + V3d(0, 0, pupil_mm_));
        const double radius = target.at_infinity ? target.radius_m : 1e3 * target.radius_m;
        out.per_radius[i] = static_cast<float>(1 / radius);
        out.at_infinity[i] = target.at_infinity ? -1 : 0;
        out.chance[i] = listed.chance;
        out.on[i] = -1;
        out.listed[lane] = &listed;
    }
    return out;
}

LensRay<Dual<f8>> LensTargets::trace(const TargetPoints& at, f8 l, f8 m) const {
    LensRay<Dual<f8>> ray =
        aimer_.leave(at.film_mm, Dual<f8>{l, splat8(1), f8{}}, Dual<f8>{m, f8{}, splat8(1)});
    static_cast<void>(trace_lens<Dual<f8>>({lens_, Towards::Scene, {0, lens_.last()}, Clip::No},
                                           at.indices, ray));
    return ray;
}

FoundDirections LensTargets::search(const TargetPoints& at, const Goals& goal, m8 wanted,
                                    const PlanePoint<f8>& on, const Guess& from,
                                    Landing& last) const {
    return find_directions(wanted, from.l, from.m, kSame / 3 * cosine_reach_,
                           [&](f8 l_now, f8 m_now) -> DirectionStep {
                               last = Landing(trace(at, l_now, m_now), goal);
                               const f8 left_x = on.x - last.x, left_y = on.y - last.y;
                               const PlanePoint<f8> by = last.parameters(left_x, left_y);
                               const f8 near = kTolerance + kRounding * last.radii;
                               return {by.x, by.y,
                                       last.ahead & (l_now * l_now + m_now * m_now < 1.f),
                                       left_x * left_x + left_y * left_y < near * near};
                           });
}

TargetChoice LensTargets::choose(const std::array<TargetList, 8>& targets,
                                 std::span<const Sampler> samplers) {
    TargetChoice out;
    for (size_t i = 0; i < samplers.size(); ++i) {
        if (targets[i].empty()) continue;
        const V2f pick = samplers[i].get2(Dim::TargetPick);
        const V2f on = uniform_disk(samplers[i].get2(Dim::TargetPoint));
        const int lane = static_cast<int>(i);
        out.target[i] = static_cast<int>(picked(targets[i], pick.x));
        out.x[lane] = on.x, out.y[lane] = on.y, out.way[lane] = pick.y;
    }
    return out;
}

// Each start leads the search to a way, or to one that is known already. Ways outside the iris, or
// through rims, bring no light.
auto LensTargets::ways(const TargetPoints& at, const Goals& goal, m8 wanted, f8 x, f8 y) const
    -> Ways {
    Ways out;
    out.count = goal.most_starts(wanted);
    for (int b = 0; b < out.count; ++b) {
        Guess guess;
        m8 asked{};
        for (int i = 0; i < 8; ++i) {
            const auto lane = static_cast<size_t>(i);
            if (!wanted[i] || b >= goal.listed[lane]->start_count) continue;
            asked[i] = -1;
            guess.put(i, goal.listed[lane]->starts[size_t(b)], at.film_mm[i], {x[i], y[i]});
        }
        Landing landing;
        const FoundDirections found = search(at, goal, asked, {x, y}, guess, landing);
        const AimedRay<f8> crossed = aimer_.cross<f8>(at.film_mm, found.l, found.m, at.indices);
        const f8 stop_x = crossed.ray.origin.x, stop_y = crossed.ray.origin.y;
        const auto reach = static_cast<float>(stop_reach_mm_);
        m8 passes = found.found & crossed.clear & crossed.ray.alive() &
                    (stop_x * stop_x + stop_y * stop_y <= sqr(reach));
        for (int a = 0; a < b; ++a) passes &= ~same(out.l[a] - found.l, out.m[a] - found.m);
        const f8 light = crossed.stretch_mm2() / landing.size();
        out.l[b] = found.l, out.m[b] = found.m;
        out.light[b] = select8(passes & (light > 0.f), light, f8{});
        out.all += out.light[b];
    }
    return out;
}

FoundDirections LensTargets::find(const TargetPoints& at, const TargetChoice& choice) const {
    const Goals goal = goals(at.targets, choice.target);
    const Ways found = ways(at, goal, goal.on, choice.x, choice.y);
    FoundDirections out{};
    f8 left = choice.way * found.all;
    m8 picked{};
    for (int b = 0; b < found.count; ++b) {
        // What rounding leaves goes to the last way.
        const m8 here = ~picked & (found.light[b] > 0.f);
        out.l = here ? found.l[b] : out.l;
        out.m = here ? found.m[b] : out.m;
        picked |= here & (left < found.light[b]);
        left -= select8(here, found.light[b], f8{});
    }
    out.found = found.all > 0.f;
    return out;
}

f8 LensTargets::density(const TargetPoints& at, f8 l, f8 m) const {
    f8 sum{};
    size_t most = 0;
    for (const TargetList& list : at.targets) most = std::max(most, list.size());
    if (most == 0) return sum;
    const LensRay<Dual<f8>> ray = trace(at, l, m);
    for (int k = 0; k < static_cast<int>(most); ++k) {
        std::array<int, 8> which;
        which.fill(k);
        const Goals goal = goals(at.targets, which);
        const Landing here(ray, goal);
        const m8 passes = here.ahead & (here.x * here.x + here.y * here.y <= 1.f);
        if (!any(passes)) continue;
        const Ways found = ways(at, goal, passes, here.x, here.y);
        f8 light{};
        for (int b = 0; b < found.count; ++b)
            light += select8(same(found.l[b] - l, found.m[b] - m), found.light[b], f8{});
        sum += select8(passes & (light > 0.f),
                       light / found.all * goal.chance * here.size() * (1 / kPi), f8{});
    }
    return sum;
}

}  // namespace petzval
