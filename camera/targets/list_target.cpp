// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/list_target.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "camera/targets/stop_region.h"

namespace petzval::camera {
namespace {

/// Radius of the circle of confusion up to which a target counts as sharp.
constexpr float kSharp_px = 0.6f;
/// Share of the points of the stop from which on those that see a target sharply are its core.
constexpr float kCore = 0.25f;
/// Margin of the part of the film that sees a target.
constexpr float kMore = 0.06f;

/// The target in the frame of a map; nothing where it lies behind.
std::optional<ListedTarget> in_frame(const StopMap& map, const Pose& pose, const Target& target) {
    const V3d at = target.at_infinity ? map.turned(pose.local(target.centre))
                                      : map.local(pose.local(target.centre - pose.origin));
    if (!(at.z > 0)) return std::nullopt;
    ListedTarget out{};
    const float slant = std::sqrt(1 + sqr(map.most_slope()));
    const auto z = static_cast<float>(at.z);
    if (target.at_infinity) {
        const float per = 1 / (target.radius_m * slant * slant);
        out.centre = V2f(V2d(at.x / at.z, at.y / at.z)) * per;
        out.by_place = Linear2f() * 0.f, out.by_slope = Linear2f() * per;
    } else if (const auto& image = target.image) {
        const auto turned = [&](const V3f& d) { return V3f(map.turned(pose.local(d))); };
        const V3f along = turned(image->along), x = turned(image->x), y = turned(image->y);
        if (!(along.z > 0)) return std::nullopt;
        const Linear2f across{V2f(x.x, y.x), V2f(x.y, y.y)};
        out.by_place = image->place_per_m.after(across);
        const Linear2f by_direction =
            image->place_per_m.after(image->passes_m).after(across) * along.z;
        out.by_slope = out.by_place * z + by_direction * -1.f;
        out.centre =
            out.by_place(V2f(V2d(at.x, at.y))) - by_direction(V2f(along.x, along.y) / along.z);
    } else {
        const float per = 1 / (target.radius_m * slant);
        out.centre = V2f(V2d(at.x, at.y)) * per;
        out.by_place = Linear2f() * per, out.by_slope = Linear2f() * (z * per);
    }
    out.most = V2f(out.by_place.most(), out.by_slope.most());
    return out;
}

/// Points of the stop: its middle, and so many on each of three rings.
std::vector<V2f> points_of_stop(int on_ring) {
    std::vector<V2f> out{V2f(0.f)};
    for (const float radius : {0.5f, 0.8f, 1.f})
        for (int i = 0; i < on_ring; ++i) {
            const float angle = 2 * kPi / float(on_ring) * (float(i) + radius);
            out.push_back(V2f(std::cos(angle), std::sin(angle)) * radius);
        }
    return out;
}

/// Of some points of the stop the most that see a target from one place of the film, sharply.
std::vector<V2f> sharp_together(const StopMap& map, const ListedTarget& target, V2f film,
                                V2i frame_px, const std::vector<V2f>& stops) {
    const StopMap::Rays rays = map.rays(film, kMiddle_nm);
    const auto by_film = map.rays_by_film(film);
    std::vector<V2f> at_px, best;
    for (const V2f& stop : stops)
        at_px.push_back(
            FilmMotion(by_film, target, stop).film_for(landing(at(rays, stop), target)) *
            V2f(frame_px));
    for (const V2f& middle : at_px) {
        std::vector<V2f> together;
        for (size_t k = 0; k < stops.size(); ++k)
            if ((at_px[k] - middle).length() < kSharp_px) together.push_back(stops[k]);
        if (together.size() > best.size()) best = std::move(together);
    }
    return best;
}

/// Film point of the cell from which the middle of the stop sees a target, or nearly.
V2f pictured(const StopMap& map, const ListedTarget& target) {
    V2f film = map.middle();
    for (int step = 0; step < 3; ++step) {
        const FilmMotion by(map.rays_by_film(film), target, V2f(0.f));
        film -= by.film_for(landing(at(map.rays(film, kMiddle_nm), V2f(0.f)), target));
        film =
            V2f(std::clamp(film.x, map.middle().x - map.half().x, map.middle().x + map.half().x),
                std::clamp(film.y, map.middle().y - map.half().y, map.middle().y + map.half().y));
    }
    return film;
}

/// Film points that see a target, by those that do so through points of the stop.
FilmOctagon seen_from(const StopMap& map, const ListedTarget& target, V2i frame_px,
                      const std::vector<V2f>& stops) {
    FilmOctagon out;
    out.low.fill(INFINITY), out.high.fill(-INFINITY);
    out.beyond = V2f(kFilterReach_px) / V2f(frame_px);
    const auto by_film = map.rays_by_film(map.middle());
    std::array<StopMap::Rays, StopMap::kTried_nm.size()> rays;
    std::transform(StopMap::kTried_nm.begin(), StopMap::kTried_nm.end(), rays.begin(),
                   [&](float nm) { return map.rays(map.middle(), nm); });
    for (const V2f& stop : stops) {
        const FilmMotion by(by_film, target, stop);
        const float error = target.in_radii(map.error(StopMap::square(stop)));
        // The target's radius, and the reach of a filter.
        const std::array<V2f, 4> across{by.down, by.right, by.down - by.right, by.down + by.right};
        for (const StopMap::Rays& of_nm : rays) {
            const V2f film = map.middle() - by.film_for(landing(at(of_nm, stop), target));
            const auto along = FilmOctagon::along(film);
            for (size_t k = 0; k < 4; ++k) {
                const float reach =
                    (1 + error) * across[k].length() / by.area() + out.beyond_along(k);
                out.low[k] = std::min(out.low[k], along[k] - reach);
                out.high[k] = std::max(out.high[k], along[k] + reach);
            }
        }
    }
    for (size_t k = 0; k < 4; ++k) {
        const float more = kMore * (out.high[k] - out.low[k]);
        out.low[k] -= more, out.high[k] += more;
    }
    return out;
}

/// Evaluations of the map for a ray to a target, on average over places that see it.
float search_of(const StopMap& map, const ListedTarget& target) {
    const FilmCell seen =
        target.seen_from.within({map.middle() - map.half(), map.middle() + map.half()});
    float sum = 0;
    for (const V2f& at : {V2f(0.25f), V2f(0.75f, 0.25f), V2f(0.25f, 0.75f), V2f(0.75f)}) {
        const V2f film = seen.first + at * (seen.last - seen.first);
        sum += float(StopRegion(map, map.rays(film, kMiddle_nm), target).evaluations());
    }
    return sum / 4;
}

}  // namespace

std::optional<ListedTarget> list_target(const Target& target, const StopMap& map, const Pose& pose,
                                        V2i frame_px, double iris_mm2) {
    auto out = in_frame(map, pose, target);
    if (!out) return out;
    const StopMap::Rays middle = map.rays(map.middle(), kMiddle_nm);
    out->squares = StopMap::kOnDisc;
    const float moves = out->in_radii(map.moves());
    const StopRegion seen_by_cell(map, middle, *out, moves);
    if (seen_by_cell.empty()) return std::nullopt;
    out->squares = seen_by_cell.squares();
    const float area = seen_by_cell.area();
    out->met = static_cast<float>(
        std::min(1., double(area * map.stretch_mm2() / sqr(1 + moves)) / iris_mm2));
    // As seen from the film point that sees its middle.
    const V2f film = pictured(map, *out);
    const std::vector<V2f> few = points_of_stop(5),
                           sharp = sharp_together(map, *out, film, frame_px, few);
    out->is_sharp = sharp.size() == few.size();
    out->seen_from = seen_from(map, *out, frame_px, points_of_stop(16));
    if (!out->is_sharp && float(sharp.size()) > kCore * float(few.size()))
        out->core = seen_from(map, *out, frame_px, sharp);
    out->search = out->is_sharp ? 0 : search_of(map, *out);
    return out;
}

}  // namespace petzval::camera
