// SPDX-License-Identifier: Apache-2.0
// How far a picture goes from what its samples show to what regressions make of them: all the way
// where noise is more than what a regression blurs, and less where it is less.
#pragma once

#include <array>
#include <vector>

#include "core/film/film.h"

namespace petzval::integrator {

/// Pixels around a pixel that tell how much of its noise is taken away.
inline constexpr int kShrinkageRadius_px = 10;
/// Pixels around each of these that tell how bright it is.
inline constexpr int kBrightnessRadius_px = 4;
/// How far away estimates are looked at.
inline constexpr int kShrinkageReach_px = kShrinkageRadius_px + kBrightnessRadius_px;

/// Samples of each half from which on both tell which parts of the estimates are best; below, the
/// first one is shown. With 2 of each, a picture of small lamps said 3 where its relative error was
/// 7.
inline constexpr uint32_t kLeastSamplesToChoose = 8;

/// Estimates that are made of each pixel: one that keeps more detail, one that leaves less noise.
inline constexpr size_t kEstimates = 2;

/// Estimates of a picture's pixels from each half of their samples, row by row.
struct HalfEstimates {
    Rect pixels;
    std::array<std::array<std::vector<V3f>, kEstimates>, kHalves> colour;  ///< nits
    size_t bins_each;  ///< bins of a pixel; none of a film without
    bool can_choose;   ///< whether a pixel has samples enough for the second estimate to count
    /// W/(m2 sr nm), pixel-major.
    std::array<std::array<std::vector<float>, kEstimates>, kHalves> bins;

    /// Black estimates of these pixels of a film.
    HalfEstimates(const Film& film, const Rect& of)
        : pixels(of),
          bins_each(film.spectral() ? static_cast<size_t>(film.spectral()->bins().count) : 0),
          can_choose(film.taken_range().most >= kHalves * kLeastSamplesToChoose) {
        const auto count = static_cast<size_t>(of.width()) * static_cast<size_t>(of.height());
        for (auto& half : colour)
            for (auto& estimate : half) estimate.resize(count, V3f(0));
        for (auto& half : bins)
            for (auto& estimate : half) estimate.resize(count * bins_each);
    }
    [[nodiscard]] size_t offset(int x, int y) const {
        return static_cast<size_t>(y - pixels.y0) * pixels.width() + (x - pixels.x0);
    }
};

/// Denoised picture of a film's crop, row by row.
struct Denoised {
    Rect crop;
    /// Nits: between the mean of both halves and the means of their estimates.
    std::vector<V3f> colour;
    /// (colour - truth)^2 of R, G and B, nits^2: it may be negative, and says little of one pixel
    /// and much of a thousand. Their mean has no bias but for `doubt`.
    std::vector<V3f> squared_error;
    /// What of squared_error hangs on how the truth is known where a pixel's own noise had a part
    /// in what is shown of it, nits^2.
    std::vector<V3f> doubt;
    /// Of a film with bins, by the same weights as colour: W/(m2 sr nm), pixel-major.
    std::vector<float> bins;

    [[nodiscard]] size_t offset(int x, int y) const {
        return static_cast<size_t>(y - crop.y0) * crop.width() + (x - crop.x0);
    }
};

/// Writes the denoised pixels of a tile, and their squared errors. The film has two halves, and
/// their estimates are there up to kShrinkageReach_px away from the tile, as far as the frame goes.
void shrink_tile(const Film&, const HalfEstimates&, const Rect& tile, Denoised&);

}  // namespace petzval::integrator
