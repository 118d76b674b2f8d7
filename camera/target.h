// SPDX-License-Identifier: Apache-2.0
// Targets: small bright things that a camera sends rays to, beside those that it draws anyway.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/film_cell.h"
#include "core/math/astigmatic_image.h"

namespace petzval::camera {

/// A ball in the scene, or an image in its place. It is a window that rays go through, not an
/// object: whatever a ray meets, the picture stays right, and only its noise depends on where
/// targets are.
struct Target {
    V3f centre;                ///< world, metres; a unit direction for what lies at infinity
    float radius_m = 0;        ///< above 0; at infinity the tangent of the angle
    bool at_infinity = false;  ///< a spot of the sky
    std::optional<AstigmaticImage> image{};
};

/// Distance from the middle of a pixel within which its film points lie, mostly.
inline constexpr float kFilterReach_px = 1.5f;

/// Eight-sided part of the film: by x, y, x + y and x - y of its points.
struct FilmOctagon {
    std::array<float, 4> low{}, high{};
    V2f beyond{0.f};  ///< how far it reaches beyond, for the middles of pixels

    [[nodiscard]] static std::array<float, 4> along(V2f film) {
        return {film.x, film.y, film.x + film.y, film.x - film.y};
    }
    [[nodiscard]] bool contains(const std::array<float, 4>& along) const {
        bool in = true;
        for (size_t k = 0; k < 4; ++k) in &= along[k] >= low[k] && along[k] <= high[k];
        return in;
    }
    /// Whether a film point lies in it, the part for the middles of pixels left out.
    [[nodiscard]] bool contains_point(V2f film) const {
        const auto at = along(film);
        bool in = true;
        for (size_t k = 0; k < 4; ++k) {
            in &= at[k] >= low[k] + beyond_along(k) && at[k] <= high[k] - beyond_along(k);
        }
        return in;
    }
    /// How far it reaches beyond along one of its four directions; of x + y and x - y about.
    [[nodiscard]] float beyond_along(size_t k) const {
        return k == 0 ? beyond.x : k == 1 ? beyond.y : beyond.length();
    }
    /// Rectangle about its part of a cell; of no area where they do not meet.
    [[nodiscard]] FilmCell within(const FilmCell& cell) const {
        const V2f first = cell.nearest({low[0], low[1]}), last = cell.nearest({high[0], high[1]});
        return {first, last};
    }
};

/// A target as the film points of a cell see it, by the rays of a StopMap.
///
/// A ray that passes the plane of the map at p with the slopes m lands at
/// by_place(p) + by_slope(m) - centre: within 1 where it passes the target.
struct ListedTarget {
    V2f centre;
    Linear2f by_place, by_slope;
    V2f most{0.f};          ///< that by_place and by_slope stretch anything
    FilmOctagon seen_from;  ///< film points that may see it, and middles of their pixels
    /// Squares of the map that rays may cross on their way here, by bits.
    uint64_t squares = 0;
    /// About all of the stop sees it from one pixel: film points are drawn for points of the stop.
    bool is_sharp = false;
    /// A good part of the stop does: middles of the pixels that draw film points for half of the
    /// rays to it.
    std::optional<FilmOctagon> core{};
    float chance = 1;     ///< that a ray is sent to it, among those that a film point may see
    float search = 0;     ///< evaluations of the map that a ray to it takes, on average
    float met = 0;        ///< share of ordinary rays that pass it, about
    uint32_t number = 0;  ///< in TargetGrid::targets

    /// Share of a pixel's rays to it that draw the film point; along: of the pixel's middle.
    [[nodiscard]] float film_share(const std::array<float, 4>& along) const {
        return is_sharp ? 1 : core && core->contains(along) ? 0.5f : 0;
    }
    /// Length on the target, in its radii, of a length in the plane and a slope.
    [[nodiscard]] float in_radii(V2f place_and_slope) const { return most.dot(place_and_slope); }
};

class StopMap;

/// What the film points of a cell have in common: where their rays go, and what they are sent to.
struct TargetCell {
    std::shared_ptr<const StopMap> map;  ///< nullptr only where there are no targets
    std::vector<ListedTarget> targets;
    static constexpr size_t kMostTargets = 256;
    static constexpr uint32_t kMostRays = CameraSample::kMostTargetRays;
    uint32_t rays =
        1;  ///< of a sample to its targets, where all lanes share them; at most kMostRays
    float light_nits = 0;  ///< of all its targets, on average, if nothing hides them

    [[nodiscard]] bool empty() const { return targets.empty(); }
    /// Sum of the chances of the targets that a pixel may see, by the middle of it.
    [[nodiscard]] float chances(const std::array<float, 4>& along) const {
        float sum = 0;
        for (const ListedTarget& t : targets) sum += t.seen_from.contains(along) ? t.chance : 0;
        return sum;
    }
};

/// Cell of each film point of a batch; nullptr: no targets.
using CellsOfPoints = std::span<const TargetCell* const>;

/// Targets of each part of a frame, by a grid of cells.
struct TargetGrid {
    V2i cells{0, 0};
    std::vector<TargetCell> lists;  ///< row by row
    std::vector<Target> targets;    ///< all of them

    /// Film points that are middles of pixels of a cell.
    [[nodiscard]] FilmCell cell(int i, int j) const {
        return {V2f(V2i(i, j)) / V2f(cells), V2f(V2i(i + 1, j + 1)) / V2f(cells)};
    }
    /// Cell of a pixel, by its middle, as FilmPoint has it; beyond the frame, the nearest.
    [[nodiscard]] const TargetCell& at(V2f film) const {
        const auto cell = [](float share, int count) {
            return static_cast<size_t>(
                std::clamp(static_cast<int>(share * static_cast<float>(count)), 0, count - 1));
        };
        return lists[cell(film.y, cells.y) * static_cast<size_t>(cells.x) + cell(film.x, cells.x)];
    }
};

}  // namespace petzval::camera
