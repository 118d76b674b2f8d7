// SPDX-License-Identifier: Apache-2.0
#include "camera/models/lens_targets.h"

#include <algorithm>
#include <cmath>

#include "camera/lens/trace.h"
#include "core/sampling/warp.h"
#include "core/spectrum/glass.h"

namespace petzval {
namespace {

/// Distance from the chosen point at which a ray is there, in radii of the target; what floats
/// leave of a distance comes to it.
constexpr float kTolerance = 1e-3f, kRounding = 3e-7f;
/// Rays of a film point that are tried as starts.
constexpr int kTried = 24;
/// Of them, those that are tried for a cell.
constexpr size_t kMostTried = 16;
/// How far from the iris what is found may lie, in its radii: a target's rim is met from a little
/// farther away than its middle.
constexpr float kMostSpanned = 0.25f;
/// Starts this far from a cell, in its diagonals, may lead to ways of its own.
constexpr float kNearCells = 0.25f;
constexpr size_t kMostPlaces = 6;
/// Longest step of a film point: beyond it the search has lost its way.
constexpr float kMostFilmStep_mm = 30;
/// Distance of a start's ray from the middle of the target, in radii, that its derivatives mend.
constexpr float kNearRadii = 3;

f8 select8(m8 on, f8 a, f8 b) {
    return on ? a : b;
}
Vec3<f8> negated(const Vec3<f8>& a) {
    return a * -1.f;
}

/// Guesses for eight film points and points of their targets, from a start of each.
struct Guess {
    f8 l{}, m{};
    void put(int i, const TargetStart& start, V2f film_mm, V2f on) {
        const V2f off = film_mm - start.film_mm;
        const V2f lm = start.cosines + start.by_film_x * off.x + start.by_film_y * off.y +
                       start.by_across * on.x + start.by_up * on.y;
        l[i] = lm.x, m[i] = lm.y;
    }
};

}  // namespace

/// Targets of eight lanes, in the space of the lens.
struct LensTargets::Goals {
    Vec3<f8> normal{}, centre{}, across{}, up{};  ///< centre: at infinity the direction
    f8 per_radius{}, chance{};
    m8 at_infinity{}, on{};
    std::array<const ListedTarget*, 8> listed{};

    [[nodiscard]] int most_starts(m8 wanted) const {
        int most = 0;
        for (size_t i = 0; i < 8; ++i)
            if (wanted[static_cast<int>(i)]) most = std::max<int>(most, listed[i]->start_count);
        return most;
    }
};

/// Where rays meet the planes of targets, in radii from their middles, and the derivatives by the
/// two parameters of the ray.
struct LensTargets::Landing {
    f8 x{}, y{}, x_by_u{}, y_by_u{}, x_by_v{}, y_by_v{};
    f8 radii{};  ///< distance to the plane
    m8 ahead{};  ///< lanes whose ray leads there

    Landing() = default;
    Landing(const LensRay<Dual<f8>>& ray, const Goals& goal) {
        const auto part = [](const Vec3<Dual<f8>>& a, auto which) {
            return Vec3<f8>{a.x.*which, a.y.*which, a.z.*which};
        };
        constexpr auto value = &Dual<f8>::value;
        const Vec3<f8> origin = part(ray.origin, value), d = part(ray.direction, value);
        const Vec3<f8> away = select(goal.at_infinity, goal.centre, goal.centre + negated(origin));
        const f8 across = dot(goal.normal, d), t = dot(goal.normal, away) / across;
        const Vec3<f8> from_centre = d * t + negated(away);
        x = dot(goal.across, from_centre) * goal.per_radius;
        y = dot(goal.up, from_centre) * goal.per_radius;
        const auto change = [&](auto which, f8& x_by, f8& y_by) {
            const Vec3<f8> moved = select(goal.at_infinity, Vec3<f8>{}, part(ray.origin, which)) +
                                   part(ray.direction, which) * t;
            const Vec3<f8> in_plane = moved + d * (-dot(goal.normal, moved) / across);
            x_by = dot(goal.across, in_plane) * goal.per_radius;
            y_by = dot(goal.up, in_plane) * goal.per_radius;
        };
        change(&Dual<f8>::du, x_by_u, y_by_u);
        change(&Dual<f8>::dv, x_by_v, y_by_v);
        radii = t * goal.per_radius;
        ahead = goal.on & ray.alive() & (t > 0.f);
    }
    [[nodiscard]] f8 determinant() const { return x_by_u * y_by_v - x_by_v * y_by_u; }
    /// Area on the target for a unit of the parameters, in squared radii.
    [[nodiscard]] f8 size() const {
        const f8 d = determinant();
        return d < 0.f ? -d : d;
    }
    /// What the parameters must change for x and y to change by so much.
    [[nodiscard]] PlanePoint<f8> parameters(f8 by_x, f8 by_y) const {
        const f8 per = 1 / determinant();
        return {(y_by_v * by_x - x_by_v * by_y) * per, (x_by_u * by_y - y_by_u * by_x) * per};
    }
};

/// Distinct directions from which rays pass one point, by the start that led to each.
struct LensTargets::Ways {
    int count = 0;
    std::array<f8, ListedTarget::kMostStarts> l{}, m{};
    std::array<f8, ListedTarget::kMostStarts> light{};  ///< in any unit; 0: no way, or known before
    std::array<f8, ListedTarget::kMostStarts> size{};   ///< Landing::size()
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
    static_cast<void>(
        trace_lens<Dual<f8>>(lens_, at.indices, Towards::Scene, {0, lens_.last()}, ray, Clip::No));
    return ray;
}

FoundDirections LensTargets::search(const TargetPoints& at, const Goals& goal, m8 wanted, f8 x,
                                    f8 y, f8 l, f8 m, Landing& last) const {
    return find_directions(
        wanted, l, m, kSame / 3 * cosine_reach_, [&](f8 l_now, f8 m_now) -> DirectionStep {
            last = Landing(trace(at, l_now, m_now), goal);
            const f8 left_x = x - last.x, left_y = y - last.y;
            const PlanePoint<f8> by = last.parameters(left_x, left_y);
            const f8 near = kTolerance + kRounding * last.radii;
            return {by.x, by.y, last.ahead & (l_now * l_now + m_now * m_now < 1.f),
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
        const FoundDirections found = search(at, goal, asked, x, y, guess.l, guess.m, landing);
        const AimedRay<f8> crossed = aimer_.cross<f8>(at.film_mm, found.l, found.m, at.indices);
        const f8 stop_x = crossed.ray.origin.x, stop_y = crossed.ray.origin.y;
        const auto reach = static_cast<float>(stop_reach_mm_);
        m8 passes = found.found & crossed.clear & crossed.ray.alive() &
                    (stop_x * stop_x + stop_y * stop_y <= sqr(reach));
        for (int a = 0; a < b; ++a) passes &= ~same(out.l[a] - found.l, out.m[a] - found.m);
        out.size[b] = landing.size();
        const f8 light = crossed.stretch_mm2() / out.size[b];
        out.l[b] = found.l, out.m[b] = found.m;
        out.light[b] = select8(passes & (light > 0.f), light, f8{});
        out.all += out.light[b];
    }
    return out;
}

SentRays LensTargets::find(const TargetPoints& at, const TargetChoice& choice) const {
    const Goals goal = goals(at.targets, choice.target);
    const Ways found = ways(at, goal, goal.on, choice.x, choice.y);
    SentRays out;
    out.target = choice.target;
    f8 left = choice.way * found.all;
    m8 picked{};
    for (int b = 0; b < found.count; ++b) {
        // What rounding leaves goes to the last way.
        const m8 here = ~picked & (found.light[b] > 0.f);
        out.directions.l = here ? found.l[b] : out.directions.l;
        out.directions.m = here ? found.m[b] : out.directions.m;
        out.density = here ? found.light[b] * found.size[b] : out.density;
        picked |= here & (left < found.light[b]);
        left -= select8(here, found.light[b], f8{});
    }
    out.directions.found = found.all > 0.f;
    out.density =
        select8(out.directions.found, out.density / found.all * goal.chance * (1 / kPi), f8{});
    return out;
}

f8 LensTargets::density(const TargetPoints& at, f8 l, f8 m, const SentRays& known) const {
    f8 sum = known.density;
    size_t most = 0;
    for (const TargetList& list : at.targets) most = std::max(most, list.size());
    if (most == 0) return sum;
    const LensRay<Dual<f8>> ray = trace(at, l, m);
    for (int k = 0; k < static_cast<int>(most); ++k) {
        std::array<int, 8> which;
        which.fill(k);
        const Goals goal = goals(at.targets, which);
        const Landing here(ray, goal);
        m8 passes = here.ahead & (here.x * here.x + here.y * here.y <= 1.f);
        for (int i = 0; i < 8; ++i)
            if (known.target[static_cast<size_t>(i)] == k) passes[i] = 0;
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

TargetStart LensTargets::start_at(const TargetPoints& at, const Goals& goal, f8 l, f8 m,
                                  int lane) const {
    const Landing here(trace(at, l, m), goal);
    // The same rays, with derivatives by the film point in place of the direction.
    LensRay<Dual<f8>> moved = aimer_.leave(at.film_mm, Dual<f8>{l}, Dual<f8>{m});
    moved.origin.x.du = splat8(1);
    moved.origin.y.dv = splat8(1);
    static_cast<void>(trace_lens<Dual<f8>>(lens_, at.indices, Towards::Scene, {0, lens_.last()},
                                           moved, Clip::No));
    const Landing by_film(moved, goal);
    const auto change = [&](f8 by_x, f8 by_y) { return here.parameters(by_x, by_y)[lane]; };
    return {at.film_mm[lane],
            V2f(l[lane], m[lane]) - change(here.x, here.y),
            change(-by_film.x_by_u, -by_film.y_by_u),
            change(-by_film.x_by_v, -by_film.y_by_v),
            change(splat8(1), f8{}),
            change(f8{}, splat8(1))};
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
        for (int i = 0; i < 8; ++i)
            if (seen.found[i] && near_film(seen.film_mm[i]))
                out.starts.push_back(start_at(at, goal, seen.l, seen.m, i));
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

// All starts are tried. Rays far outside the iris are no ways.
auto LensTargets::ways_from(V2f place_mm, const Goals& goal, const LensIndices<f8>& indices,
                            std::span<const TargetStart* const> starts) const
    -> std::vector<WayFrom> {
    std::vector<WayFrom> out;
    const TargetPoints at{PlanePoint<f8>(place_mm), indices, {}};
    for (size_t first = 0; first < starts.size(); first += 8) {
        const size_t count = std::min<size_t>(8, starts.size() - first);
        Guess guess;
        m8 asked{};
        for (size_t i = 0; i < count; ++i) {
            const int lane = static_cast<int>(i);
            guess.put(lane, *starts[first + i], place_mm, V2f(0.f));
            asked[lane] = -1;
        }
        Landing landing;
        const FoundDirections found =
            search(at, goal, asked, f8{}, f8{}, guess.l, guess.m, landing);
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
    return out;
}

// The fewest starts, about, that lead to all ways from places all over the cell.
std::optional<ListedTarget> LensTargets::listed(const PreparedTarget& target, V2f place_mm,
                                                const FilmCell& cell_mm) const {
    static_assert(kMostTried <= 32);
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
    const auto first = [&](size_t count) {
        return std::span(starts.data(), std::min(count, starts.size()));
    };
    if (ways_from(place_mm, goal, indices, first(8)).empty()) return std::nullopt;
    starts.resize(std::min(kMostTried, starts.size()));
    std::vector<WayFrom> ways = ways_from(place_mm, goal, indices, starts);
    for (const WayFrom& way : ways) out.met += way.met;
    // Beside a caustic there are ways that are seen from a start's own place only, or nearly.
    // Most of these are seen from the outer parts of the stop, whose starts are the last.
    const float near_mm = kNearCells * (cell_mm.last - cell_mm.first).length();
    size_t places = 0;
    for (size_t k = target.starts.size(); k-- > 0 && places < kMostPlaces;) {
        if (!(away_mm(&target.starts[k]) < near_mm)) continue;
        ++places;
        for (const WayFrom& way : ways_from(target.starts[k].film_mm, goal, indices, starts))
            ways.push_back(way);
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
