// SPDX-License-Identifier: Apache-2.0
// Learns how often a two-level camera (Camera::two_level) should take its difference.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "camera/camera.h"
#include "core/colour.h"
#include "core/film.h"
#include "core/filter.h"
#include "core/observer.h"
#include "integrator/path.h"
#include "integrator/split_grid.h"

namespace petzval {

/// What four split paths beside the shared one cost, and what they cost alone, in shared samples:
/// as measured with tests/bench/chroma_noise.
inline constexpr double kDifferenceCost = 1.8, kSplitCost = 2.2;
/// What is rare is not seen by the pilot, and counts 1 / p times as much: p is bounded, and what
/// the pilot found is multiplied. Stratified samples take off noise of the shared and split
/// estimates, but not of whether the difference is taken, too.
inline constexpr double kLeastSplitProbability = 0.25, kCaution = 3;
inline constexpr uint32_t kPilotPixels = 8;  ///< of each cell; two samples each

/// The probability with which an estimate's variance times its cost is least, where `share` is the
/// mean square of the difference over the variance of a split sample. With V = 1 the variance is
/// 1 + (1/p - 1) share, and the cost 1 + p kDifferenceCost; 1 where split paths alone do better.
[[nodiscard]] inline double split_probability(double share) {
    if (!(share < 1)) return 1;
    const double p =
        std::max(std::sqrt(share / (kDifferenceCost * (1 - share))), kLeastSplitProbability);
    const double inefficiency = (1 + (1 / p - 1) * share) * (1 + p * kDifferenceCost);
    return inefficiency < kSplitCost ? p : 1;
}

/// From two samples of a few pixels of each cell, traced shared and split with the same numbers.
/// Errors count as in a picture's R, G and B. What a cell gets depends on its neighbours and the
/// seed only, not on the crop or the threads; its samples are not those of any render.
template <class Tracer>
class SplitPilot {
  public:
    /// All but the seed must outlive the pilot.
    SplitPilot(const Tracer& tracer, const Camera& camera, const Observer& observer,
               const Filter& filter, V2i full_size, uint32_t seed)
        : tracer_(tracer),
          camera_(camera),
          observer_(observer),
          filter_(filter),
          full_size_(full_size),
          seed_(hash32(seed, 0x2b7e1516u)) {}

    /// Cells outside the crop get 1. stop: when it is set, the rest is left out.
    template <class Executor>
    [[nodiscard]] SplitGrid learn(const Rect& crop, Executor& executor,
                                  const std::atomic<bool>& stop) const {
        SplitGrid grid(full_size_, 1), shares(full_size_, 0);
        const Rect cells = grid.cells_of(crop), around = grid.with_neighbours(cells);
        executor.run(around.width() * around.height(), [&](int task, int) {
            if (stop) return;
            const int x = around.x0 + task % around.width(), y = around.y0 + task / around.width();
            shares.cell(x, y) = static_cast<float>(share(x, y));
        });
        for (int y = cells.y0; y < cells.y1; ++y)
            for (int x = cells.x0; x < cells.x1; ++x) {
                const Rect near = grid.with_neighbours({x, y, x + 1, y + 1});
                double sum = 0;
                for (int j = near.y0; j < near.y1; ++j)
                    for (int i = near.x0; i < near.x1; ++i) sum += double(shares.cell(i, j));
                grid.cell(x, y) = static_cast<float>(
                    split_probability(kCaution * sum / (near.width() * near.height())));
            }
        return grid;
    }

  private:
    /// Mean square of the difference over the variance within pixels, of a cell; at most 1.
    [[nodiscard]] double share(int cell_x, int cell_y) const {
        double differences = 0, variance = 0;
        for (uint32_t k = 0; k < kPilotPixels; ++k) {
            const Sampler cell(SamplerKind::Owen, seed_, {cell_x, cell_y, k});
            const V2f in_cell = cell.get2(Dim::Film);
            // Of both samples: how wavelengths differ is hardly noise where a render stratifies.
            const Bands bands = observer_.draw(cell.get1(Dim::Wavelength));
            const auto pixel = [](int column, float u, int size) {
                constexpr int side = SplitGrid::kCell_px;
                return std::min(column * side + static_cast<int>(u * side), size - 1);
            };
            const int x = pixel(cell_x, in_cell.x, full_size_.x),
                      y = pixel(cell_y, in_cell.y, full_size_.y);
            std::array<f4, 2> split;
            for (uint32_t i = 0; i < 2; ++i) {
                const SampleId id{x, y, 2 * k + i};
                split[i] = traced(id, bands, 1);
                const f4 difference = split[i] - traced(id, bands, 0);
                differences += double(hsum(difference * difference)) / 2;
            }
            const f4 apart = split[0] - split[1];
            variance += double(hsum(apart * apart)) / 2;
        }
        if (differences == 0) return 0;
        return differences < variance ? differences / variance : 1;  // 1 if they are no numbers
    }
    [[nodiscard]] f4 traced(SampleId id, const Bands& bands, float split_probability) const {
        const Sampler sampler(SamplerKind::Independent, seed_, id);
        const V2f at = V2f(id.x + 0.5f, id.y + 0.5f) + filter_.sample(sampler.get2(Dim::Film));
        const CameraSample seen =
            camera_.sample({at / V2f(full_size_), sampler, split_probability}, bands);
        f4 sum{};
        for (int k = 0; k < seen.count; ++k) {
            const CameraPath& path = seen.path[static_cast<size_t>(k)];
            FilmSample ignored;
            PathStats uncounted;
            sum += path.weight * tracer_.radiance(path.ray, bands, sampler, false, ignored,
                                                  uncounted, path.lanes);
        }
        return to_rgb(sum, bands).v;
    }

    const Tracer& tracer_;
    const Camera& camera_;
    const Observer& observer_;
    const Filter& filter_;
    V2i full_size_;
    uint32_t seed_;
};

}  // namespace petzval
