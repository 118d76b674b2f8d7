// SPDX-License-Identifier: Apache-2.0
// Denoiser: a first-order regression in a window about each pixel (Bitterli, Rousselle, Moon et al.
// 2016, "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings"). It
// needs no training, and sees each half of the samples by itself. What both halves part by tells
// how much of its estimate is taken (shrinkage.h), and its error.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "core/film/film.h"
#include "core/film/grown.h"
#include "integrator/denoise/pilots.h"
#include "integrator/denoise/shrinkage.h"

namespace petzval::integrator {

/// Side of the tiles in which a picture is denoised.
inline constexpr int kDenoiserTile_px = 32;

/// Writes the first estimates of a tile's pixels by each half of a film's samples, as far as there
/// is room for them, and what the second ones need of them.
void estimate_first(const Film&, const Rect& tile, HalfEstimates&, Pilots&);

/// Writes the second estimates of a tile's pixels. Pilots and first estimates are there up to
/// kPilotReach_px away from the tile, as far as the frame goes.
void estimate_second(const Film&, const Rect& tile, const Pilots&, HalfEstimates&);

/// Denoises what a film with halves shows: nothing where `stop` is set meanwhile. Threads and crops
/// do not change a bit of a pixel.
template <class Executor>
[[nodiscard]] std::optional<Denoised> denoise(const Film& film, Executor& executor,
                                              const std::atomic<bool>* stop = nullptr) {
    const auto each_tile = [&](const Rect& of, const auto& use) {
        const auto tiles = [](int length_px) {
            return (length_px + kDenoiserTile_px - 1) / kDenoiserTile_px;
        };
        const int across = tiles(of.width());
        executor.run(across * tiles(of.height()), [&](int task, int) {
            if (stop && *stop) return;
            const int x0 = of.x0 + task % across * kDenoiserTile_px,
                      y0 = of.y0 + task / across * kDenoiserTile_px;
            use(Rect{x0, y0, std::min(x0 + kDenoiserTile_px, of.x1),
                     std::min(y0 + kDenoiserTile_px, of.y1)});
        });
    };
    const Rect crop = film.crop();
    HalfEstimates estimates(film, grown(crop, kShrinkageReach_px, film.pixels()));
    {
        Pilots pilots(film, estimates);
        each_tile(pilots.pixels,
                  [&](const Rect& t) { estimate_first(film, t, estimates, pilots); });
        if (estimates.can_choose)
            each_tile(estimates.pixels,
                      [&](const Rect& t) { estimate_second(film, t, pilots, estimates); });
    }
    const auto pixels = static_cast<size_t>(crop.width()) * static_cast<size_t>(crop.height());
    Denoised out{crop, std::vector<V3f>(pixels), std::vector<V3f>(pixels), std::vector<V3f>(pixels),
                 std::vector<float>(pixels * estimates.bins_each)};
    each_tile(crop, [&](const Rect& t) { shrink_tile(film, estimates, t, out); });
    if (stop && *stop) return std::nullopt;
    return out;
}

}  // namespace petzval::integrator
