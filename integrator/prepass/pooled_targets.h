// SPDX-License-Identifier: Apache-2.0
// What the pilot of all cells finds at each target, and what may be expected of lamps that it
// missed (Bayes).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "camera/run_tasks.h"
#include "camera/target.h"
#include "core/sampling/sampler.h"

namespace petzval::integrator {

/// Rays of a cell to all of its targets, and to one of them. Of many targets some get none.
inline constexpr double kSent = 48, kMostSent = 12;
/// Rays to an image, over all cells: surfaces send few of them on to the lamp. And of all images
/// together for a pixel.
inline constexpr double kSentToImage = 96, kMostToImages = 1. / 8;
/// Share of a lamp's radiance from which on a ray has met it, through dark glass or a lens; and
/// share of its light below which one that no ray met is left out.
inline constexpr double kMet = 1e-3, kLeastSeen = 1e-3;
/// Hits from which on what a lamp brings is known.
inline constexpr uint32_t kManyHits = 8;
/// Lamps of a cell from which on all are hidden where none is met: a wall stands before them.
inline constexpr double kAloneInCell = 3;
/// Means over the samples of cells, or over the rays to one of their targets. Luminance.
struct PilotFound {
    double counted = 0, counted2 = 0;  ///< what the shares leave, and its square
    double whole2 = 0;                 ///< square of ordinary rays in the same direction
    double cost = 0;
    double share = 0;  ///< of the cell whose film points these are; a sum of them for several cells
    double seen = 1;   ///< share of the target's light that may be expected
    uint32_t rays = 0;  ///< that were sent
    uint32_t hits = 0;  ///< of them, that met it

    void add(double whole, double weight) {
        counted += weight * whole;
        counted2 += weight * whole * weight * whole;
        whole2 += weight * whole * whole;
    }
    void add(const PilotFound& o) {
        counted += o.counted, counted2 += o.counted2, whole2 += o.whole2, cost += o.cost;
        share += o.share, rays += o.rays, hits += o.hits;
    }
    void scale(double by) { counted *= by, counted2 *= by, whole2 *= by, cost *= by, share *= by; }
    /// What a target's light adds to the variance of ordinary rays, however seldom they meet it: by
    /// the shares of the rays that are sent to it.
    [[nodiscard]] double spread() const { return std::max(0., whole2 - counted * counted); }
};

/// Light of a target, at film points that may see it, if nothing hides it; and its radiance, nits.
inline double light_of(const camera::TargetCell& cell, const camera::ListedTarget& target) {
    return double(target.chance) * double(cell.light_nits);
}
inline double radiance_of(const camera::TargetCell& cell, const camera::ListedTarget& target) {
    return light_of(cell, target) / double(target.met);
}

/// Share of a cell that may see a target.
inline double seen_share(const camera::ListedTarget& target, const camera::FilmCell& cell) {
    return double(target.seen_from.within(cell).area() / cell.area());
}

/// A lamp that few or none of some rays met.
struct Likely {
    double seen;   ///< chance that it is seen at all
    double share;  ///< of it that is seen, where it is
};

/// What is known of it (Bayes). seen: its chance before, half of which is that only a share is
/// seen, any as likely; hit: chance that a ray meets one which is wholly seen.
inline Likely likely_of(uint32_t hits, uint32_t rays, double seen, double hit) {
    const double n = rays;
    if (hits > 0) return {1, std::min(1., (hits + 1) / ((n + 2) * hit))};
    const double none = std::pow(1 - hit, n),
                 // Integrals over the share s of (1 - hit s)^n, and of s times it.
        partly = (1 - none * (1 - hit)) / (hit * (n + 1)),
                 of_share =
                     (1 - none * (1 - hit) * (1 + (n + 1) * hit)) / (hit * hit * (n + 1) * (n + 2)),
                 missed = seen * (none + partly);
    return {missed / (missed + 2 * (1 - seen)), (none + of_share) / (none + partly)};
}

/// The pilot's rays to each target: how many a cell sends, and what all cells find. (A few rays of
/// one cell miss what a part of it sees, and the picture of a target is about even.)
class PooledTargets {
  public:
    PooledTargets(const camera::TargetGrid& grid, V2i frame_px)
        : grid_(grid), shares_(grid.targets.size()), found_(grid.targets.size()) {
        const auto images = static_cast<double>(
            std::count_if(grid.targets.begin(), grid.targets.end(),
                          [](const camera::Target& t) { return t.image.has_value(); }));
        of_image_ = std::min(kSentToImage, kMostToImages * double(frame_px.x) * double(frame_px.y) /
                                               std::max(1., images));
        each_cell([&](size_t n, const camera::FilmCell& part) {
            for (const camera::ListedTarget& target : grid.lists[n].targets)
                shares_[target.number] += seen_share(target, part);
        });
    }
    /// Number of rays from a cell, drawn; share: of the cell, that may see the target.
    [[nodiscard]] uint32_t rays_from(size_t cell, const camera::ListedTarget& target,
                                     double share) const {
        double rays = std::min(kSent / double(grid_.lists[cell].targets.size()), kMostSent);
        if (grid_.targets[target.number].image)
            rays = std::max(rays, of_image_ * share / shares_[target.number]);
        const uint32_t drawn = hash32(static_cast<uint32_t>(cell), target.number);
        return static_cast<uint32_t>(rays + double(to_unit_float(drawn)));
    }
    /// Adds what a cell finds at the targets of its list.
    void add(size_t cell, const std::vector<PilotFound>& sent) {
        const std::vector<camera::ListedTarget>& targets = grid_.lists[cell].targets;
        for (size_t k = 0; k < sent.size(); ++k) found_[targets[k].number].add(sent[k]);
    }
    /// Adds up what the lamps bring that were met; once, when all cells are there.
    void finish() {
        each_cell([&](size_t n, const camera::FilmCell& part) {
            all_lamps_.add(lamps_of(n, pooled_in(n, part)));
        });
    }
    /// What a cell may expect of each of its targets. Few rays are sent to one of hundreds of
    /// lamps, and none may have met it. Of such a lamp is expected what others bring that were met,
    /// in this cell, or in all where it is about alone, by the chance that it is seen (Bayes):
    /// where most of the cell were met it is likely, where most were not it is hidden.
    [[nodiscard]] std::vector<PilotFound> in_cell(size_t cell, const camera::FilmCell& part) const {
        const camera::TargetCell& list = grid_.lists[cell];
        std::vector<PilotFound> out = pooled_in(cell, part);
        const Lamps here = lamps_of(cell, out), &lamps = here.met > 0 ? here : all_lamps_;
        if (lamps.met == 0 || (here.met == 0 && here.asked > kAloneInCell)) return out;
        // Half of the share of rays that meet a lamp: some are met less than others.
        const double hits = lamps.found.hits / (2. * lamps.found.rays),
                     seen = (here.met + 1) / (here.asked + 2);
        for (size_t k = 0; k < out.size(); ++k) {
            const camera::ListedTarget& target = list.targets[k];
            const uint32_t rays = out[k].rays;
            if (!is_lamp(target) || out[k].hits >= kManyHits) continue;
            const double share = seen_share(target, part);
            const Likely likely = likely_of(out[k].hits, rays, seen, hits);
            PilotFound expected;
            expected.seen = likely.seen * likely.share;
            if (!(expected.seen >= kLeastSeen)) expected.seen = 0;
            // Moments go by the light: of rays to the lamp, and of ordinary ones that meet it.
            // Noise counts by its mean: a lamp that is there half of the time makes half of it.
            const double light = lamps.found.counted / lamps.light * share * light_of(list, target),
                         noise = light * likely.seen * expected.seen;
            expected.counted = light * expected.seen;
            if (share > 0)
                expected.counted2 = lamps.found.counted2 / lamps.square * noise * light / share;
            expected.whole2 = lamps.found.whole2 / lamps.whole * noise * radiance_of(list, target);
            // Few hits know it badly, and low.
            if (out[k].hits > 0 && expected.whole2 <= out[k].whole2) continue;
            expected.cost = rays > 0 ? out[k].cost : lamps.found.cost / lamps.found.share * share;
            out[k] = expected;
        }
        return out;
    }

  private:
    /// Lamps to which rays were sent, and what those bring that were met. Sums: of the light if
    /// nothing hides them; of what they bring, squared over their share of the cell; and of it
    /// times their radiance.
    struct Lamps {
        double asked = 0, met = 0, light = 0, square = 0, whole = 0;
        PilotFound found;

        void add(const Lamps& o) {
            asked += o.asked, met += o.met, light += o.light, square += o.square;
            whole += o.whole;
            found.add(o.found);
        }
    };
    [[nodiscard]] bool is_lamp(const camera::ListedTarget& target) const {
        return !grid_.targets[target.number].image;
    }
    /// What all cells find at the targets of one, for so much of it as may see them.
    [[nodiscard]] std::vector<PilotFound> pooled_in(size_t cell,
                                                    const camera::FilmCell& part) const {
        std::vector<PilotFound> out;
        for (const camera::ListedTarget& target : grid_.lists[cell].targets) {
            PilotFound& found = out.emplace_back(found_[target.number]);
            found.scale(found.share > 0 ? seen_share(target, part) / found.share : 0);
        }
        return out;
    }
    [[nodiscard]] Lamps lamps_of(size_t cell, const std::vector<PilotFound>& pooled) const {
        const camera::TargetCell& list = grid_.lists[cell];
        Lamps out;
        for (size_t k = 0; k < pooled.size(); ++k) {
            const camera::ListedTarget& target = list.targets[k];
            const PilotFound& found = pooled[k];
            if (!is_lamp(target) || found.rays == 0) continue;
            ++out.asked;
            if (found.hits == 0 || !(found.share > 0)) continue;
            ++out.met, out.light += found.share * light_of(list, target);
            out.square += found.counted * found.counted / found.share;
            out.whole += found.counted * radiance_of(list, target);
            out.found.add(found);
        }
        return out;
    }
    template <class F>
    void each_cell(const F& use) const {
        camera::run_cells(camera::one_by_one, grid_.cells,
                          [&](size_t n, V2i cell) { use(n, grid_.cell(cell.x, cell.y)); });
    }

    const camera::TargetGrid& grid_;
    std::vector<double> shares_;  ///< sums over the cells
    std::vector<PilotFound> found_;
    Lamps all_lamps_;
    double of_image_;
};

}  // namespace petzval::integrator
