// SPDX-License-Identifier: Apache-2.0
// Where the search for rays to a target starts: found for the whole film, and chosen for a cell.
#include <algorithm>
#include <cmath>

#include "camera/lens/trace.h"
#include "camera/targets/lens_target_planes.h"
#include "core/spectrum/glass.h"

namespace petzval {
namespace {

/// Rays of a film point that are tried as starts.
constexpr int kTried = 24;
/// Of them, those that are tried for a cell.
constexpr size_t kMostStartsTried = 16;
/// How far from the iris what is found may lie, in its radii: a target's rim is met from a little
/// farther away than its middle.
constexpr float kMostSpanned = 0.25f;
/// Starts this far from a cell, in its diagonals, may lead to ways of its own.
constexpr float kNearCells = 0.25f;
constexpr size_t kMostPlaces = 6;
/// Longest step of a film point: beyond it the search has lost its way.
constexpr float kMostFilmStep_mm = 30;
/// Film points that move less are there.
constexpr float kStill_mm = 1e-3f;
/// Distance of a start's ray from the middle of the target, in radii, that its derivatives mend.
constexpr float kNearRadii = 3;

}  // namespace

std::array<TargetStart, 8> LensTargets::starts_at(const TargetPoints& at, const Goals& goal, f8 l,
                                                  f8 m) const {
    const Landing here(trace(at, l, m), goal);
    // The same rays, with derivatives by the film point in place of the direction.
    LensRay<Dual<f8>> moved = aimer_.leave(at.film_mm, Dual<f8>{l}, Dual<f8>{m});
    moved.origin.x.du = splat8(1);
    moved.origin.y.dv = splat8(1);
    static_cast<void>(trace_lens<Dual<f8>>({lens_, Towards::Scene, {0, lens_.last()}, Clip::No},
                                           at.indices, moved));
    const Landing by_film(moved, goal);
    const PlanePoint<f8> off = here.parameters(here.x, here.y),
                         by_x = here.parameters(-by_film.x_by_u, -by_film.y_by_u),
                         by_y = here.parameters(-by_film.x_by_v, -by_film.y_by_v),
                         by_across = here.parameters(splat8(1), f8{}),
                         by_up = here.parameters(f8{}, splat8(1));
    std::array<TargetStart, 8> out;
    for (int i = 0; i < 8; ++i)
        out[static_cast<size_t>(i)] = {
            at.film_mm[i], V2f(l[i], m[i]) - off[i], by_x[i], by_y[i], by_across[i], by_up[i]};
    return out;
}

/// Film points that see a target through given points of the stop.
struct LensTargets::Pictured {
    PlanePoint<f8> film_mm{f8{}, f8{}};
    f8 l{}, m{};  ///< of the rays
    m8 found{};
};

// Newton's method on the film points, with differences.
auto LensTargets::pictured(const Goals& goal, const LensIndices<f8>& indices,
                           const PlanePoint<f8>& stop_mm, const PlanePoint<f8>& from_mm,
                           int steps) const -> Pictured {
    constexpr float kMoved_mm = 0.01f;
    const f8 nm = splat8(static_cast<float>(kLineD_nm));
    Pictured out;
    out.film_mm = from_mm;
    const auto landing = [&](float by_x, float by_y) {
        const PlanePoint<f8> film(out.film_mm.x + by_x, out.film_mm.y + by_y);
        const FoundRays rays = aimer_.aim(film, stop_mm, indices, nm);
        out.l = rays.l, out.m = rays.m;
        Landing at(trace({film, indices, {}}, rays.l, rays.m), goal);
        at.ahead &= rays.found;
        return at;
    };
    for (int i = 0; i < steps; ++i) {
        const Landing right = landing(kMoved_mm, 0), above = landing(0, kMoved_mm),
                      here = landing(0, 0);
        const f8 x_by_x = (right.x - here.x) / kMoved_mm, y_by_x = (right.y - here.y) / kMoved_mm;
        const f8 x_by_y = (above.x - here.x) / kMoved_mm, y_by_y = (above.y - here.y) / kMoved_mm;
        const f8 per = 1 / (x_by_x * y_by_y - x_by_y * y_by_x);
        const f8 step_x = (y_by_y * here.x - x_by_y * here.y) * per;
        const f8 step_y = (x_by_x * here.y - y_by_x * here.x) * per;
        const m8 usable = here.ahead & right.ahead & above.ahead &
                          (step_x * step_x + step_y * step_y < sqr(kMostFilmStep_mm));
        out.film_mm.x -= select8(usable, step_x, f8{});
        out.film_mm.y -= select8(usable, step_y, f8{});
        if (!any(usable & (step_x * step_x + step_y * step_y > sqr(kStill_mm)))) break;
    }
    const Landing here = landing(0, 0);
    out.found = here.ahead & (here.x * here.x + here.y * here.y < sqr(kNearRadii));
    return out;
}

std::optional<PreparedTarget> LensTargets::prepared(const LocalTarget& target,
                                                    V2f half_film_mm) const {
    const LensIndices<f8> indices = lens_.exact_indices(splat8(static_cast<float>(kLineD_nm)));
    const ListedTarget listed{target, 1, 0, V2f(0.f)};
    TargetPoints at{PlanePoint<f8>(f8{}, f8{}), indices, {}};
    at.targets.fill(TargetList(&listed, 1));
    const Goals goal = goals(at.targets, {});
    const auto near_film = [&](V2f p) {
        constexpr float kBeyond = 1.3f;
        return std::fabs(p.x) < kBeyond * half_film_mm.x &&
               std::fabs(p.y) < kBeyond * half_film_mm.y;
    };
    PlanePoint<f8> from(f8{}, f8{});
    for (int i = 1; i < 8; ++i) {
        const float angle = 2 * kPi * float(i) / 7;
        from.x[i] = 0.6f * half_film_mm.x * std::cos(angle);
        from.y[i] = 0.6f * half_film_mm.y * std::sin(angle);
    }
    const Pictured middle = pictured(goal, indices, PlanePoint<f8>(V2f(0.f)), from, 8);
    PreparedTarget out{target, V2f(0.f)};
    bool found = false;
    for (int i = 0; i < 8 && !found; ++i)
        if (middle.found[i] && near_film(middle.film_mm[i]))
            out.place = middle.film_mm[i], found = true;
    if (!found) return std::nullopt;
    for (int tried = 0; tried < kTried; tried += 8) {
        const Pictured seen = pictured(goal, indices, spread(tried), PlanePoint<f8>(out.place), 5);
        at.film_mm = seen.film_mm;
        const std::array<TargetStart, 8> starts = starts_at(at, goal, seen.l, seen.m);
        for (int i = 0; i < 8; ++i)
            if (seen.found[i] && near_film(seen.film_mm[i]))
                out.starts.push_back(starts[static_cast<size_t>(i)]);
    }
    return out;
}

PlanePoint<f8> LensTargets::spread(int first) const {
    PlanePoint<f8> stop_mm(f8{}, f8{});
    for (int i = 0; i < 8; ++i) {
        // By the golden angle.
        const float n = static_cast<float>(first + i) + 0.5f;
        const float r = std::sqrt(n / kTried) * static_cast<float>(stop_reach_mm_);
        const float angle = 2.39996323f * n;
        stop_mm.x[i] = r * std::cos(angle), stop_mm.y[i] = r * std::sin(angle);
    }
    return stop_mm;
}

/// A ray from a place of a cell to the middle of a target, and the starts that lead to it, by bits.
struct LensTargets::WayFrom {
    float l, m;
    float met;  ///< share of ordinary rays that pass the target by it, about
    uint32_t starts;
};

// All starts from a first one on are tried. Rays far outside the iris are no ways.
void LensTargets::add_ways(std::vector<WayFrom>& out, V2f place_mm, const Goals& goal,
                           const LensIndices<f8>& indices,
                           std::span<const TargetStart* const> starts, size_t from) const {
    const TargetPoints at{PlanePoint<f8>(place_mm), indices, {}};
    for (size_t first = from; first < starts.size(); first += 8) {
        const size_t count = std::min<size_t>(8, starts.size() - first);
        Guess guess;
        m8 asked{};
        for (size_t i = 0; i < count; ++i) {
            const int lane = static_cast<int>(i);
            guess.put(lane, *starts[first + i], place_mm, V2f(0.f));
            asked[lane] = -1;
        }
        Landing landing;
        const FoundDirections found = search(at, goal, asked, {f8{}, f8{}}, guess, landing);
        const AimedRay<f8> crossed = aimer_.cross<f8>(at.film_mm, found.l, found.m, indices);
        const f8 met = kPi * crossed.stretch_mm2() / landing.size() / float(iris_mm2_);
        for (size_t i = 0; i < count; ++i) {
            const int lane = static_cast<int>(i);
            const V2f stop(crossed.ray.origin.x[lane], crossed.ray.origin.y[lane]);
            if (!found.found[lane] || !(met[lane] >= 0 && met[lane] < kInfinity)) continue;
            // Beyond the iris by what the target spans there, nothing of it is seen.
            const float spanned = std::min(kMostSpanned, 1.5f * std::sqrt(met[lane]));
            if (!(stop.length() < (1 + spanned) * float(stop_reach_mm_))) continue;
            const float l = found.l[lane], m = found.m[lane];
            const auto known = std::find_if(out.begin(), out.end(), [&](const WayFrom& way) {
                return sqr(way.l - l) + sqr(way.m - m) < sqr(kSame * cosine_reach_);
            });
            if (known != out.end())
                known->starts |= 1u << (first + i);
            else
                out.push_back({l, m, met[lane], 1u << (first + i)});
        }
    }
}

// The fewest starts, about, that lead to all ways that are found from a few places of the cell.
std::optional<ListedTarget> LensTargets::listed(const PreparedTarget& target, V2f place_mm,
                                                const FilmCell& cell_mm) const {
    static_assert(kMostStartsTried <= 32);
    ListedTarget out{target.target, 1, 0, V2f(0.f)};
    const LensIndices<f8> indices = lens_.exact_indices(splat8(static_cast<float>(kLineD_nm)));
    std::array<TargetList, 8> lists;
    lists.fill(TargetList(&out, 1));
    const Goals goal = goals(lists, {});
    std::vector<const TargetStart*> starts;
    for (const TargetStart& start : target.starts) starts.push_back(&start);
    const auto away_mm = [&](const TargetStart* s) {
        return (cell_mm.nearest(s->film_mm) - s->film_mm).length();
    };
    std::stable_sort(starts.begin(), starts.end(),
                     [&](const auto* a, const auto* b) { return away_mm(a) < away_mm(b); });
    // Those that are nearest tell whether the target is seen at all.
    constexpr size_t kNearest = 8;
    starts.resize(std::min(kMostStartsTried, starts.size()));
    const std::span all(starts);
    std::vector<WayFrom> ways;
    add_ways(ways, place_mm, goal, indices, all.first(std::min(kNearest, all.size())), 0);
    if (ways.empty()) return std::nullopt;
    add_ways(ways, place_mm, goal, indices, all, kNearest);
    for (const WayFrom& way : ways) out.met += way.met;
    // Beside a caustic there are ways that are seen from a start's own place only, or nearly.
    // Most of these are seen from the outer parts of the stop, whose starts are the last.
    const float near_mm = kNearCells * (cell_mm.last - cell_mm.first).length();
    size_t places = 0;
    for (size_t k = target.starts.size(); k-- > 0 && places < kMostPlaces;) {
        if (!(away_mm(&target.starts[k]) < near_mm)) continue;
        ++places;
        std::vector<WayFrom> here;
        add_ways(here, target.starts[k].film_mm, goal, indices, starts, 0);
        ways.insert(ways.end(), here.begin(), here.end());
    }
    while (!ways.empty() && out.start_count < ListedTarget::kMostStarts) {
        size_t best = 0;
        ptrdiff_t most = 0;
        for (size_t k = 0; k < starts.size(); ++k) {
            const auto leads = [&](const WayFrom& way) { return (way.starts >> k & 1) != 0; };
            const auto count = std::count_if(ways.begin(), ways.end(), leads);
            if (count > most) most = count, best = k;
        }
        out.starts[out.start_count++] = *starts[best];
        std::erase_if(ways, [&](const WayFrom& way) { return (way.starts >> best & 1) != 0; });
    }
    return out;
}

}  // namespace petzval
