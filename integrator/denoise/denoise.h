// SPDX-License-Identifier: Apache-2.0
// Denoiser: a first-order regression in a window about each pixel (Bitterli, Rousselle, Moon et al.
// 2016, "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings"). It
// needs no training, and sees each half of the samples by itself, so that the other half tells its
// error.
#pragma once

#include <atomic>
#include <vector>

#include "core/film/film.h"

namespace petzval::integrator {

/// Denoised picture of a film's crop, row by row.
struct Denoised {
    Rect crop;
    std::vector<V3f> colour;  ///< nits: mean of what comes of both halves
    /// (colour - truth)^2 of R, G and B, nits^2, without bias: it may be negative, and says little
    /// of one pixel and much of a thousand.
    std::vector<V3f> squared_error;

    [[nodiscard]] size_t offset(int x, int y) const {
        return static_cast<size_t>(y - crop.y0) * crop.width() + (x - crop.x0);
    }
};

/// Side of the tiles in which a picture is denoised.
inline constexpr int kDenoiserTile_px = 32;

/// Denoises a tile of a film with halves. What comes of a pixel follows from the samples that are
/// at most kDenoiserReach_px away from it.
void denoise_tile(const Film&, const Rect& tile, Denoised&);

/// Denoises what a film with halves shows: nothing where `stop` is set meanwhile. Threads and crops
/// do not change a bit of a pixel.
template <class Executor>
[[nodiscard]] std::optional<Denoised> denoise(const Film& film, Executor& executor,
                                              const std::atomic<bool>* stop = nullptr) {
    const Rect crop = film.crop();
    const auto pixels = static_cast<size_t>(crop.width()) * static_cast<size_t>(crop.height());
    Denoised out{crop, std::vector<V3f>(pixels), std::vector<V3f>(pixels)};
    const auto tiles = [](int length_px) {
        return (length_px + kDenoiserTile_px - 1) / kDenoiserTile_px;
    };
    const int across = tiles(crop.width());
    const auto is_stopped = [&] { return stop && *stop; };
    executor.run(across * tiles(crop.height()), [&](int task, int) {
        if (is_stopped()) return;
        const int x0 = crop.x0 + task % across * kDenoiserTile_px,
                  y0 = crop.y0 + task / across * kDenoiserTile_px;
        denoise_tile(film,
                     {x0, y0, std::min(x0 + kDenoiserTile_px, crop.x1),
                      std::min(y0 + kDenoiserTile_px, crop.y1)},
                     out);
    });
    if (is_stopped()) return std::nullopt;
    return out;
}

}  // namespace petzval::integrator
