// SPDX-License-Identifier: Apache-2.0
// Pixels that a pilot renders, and for how much of the frame each stands.
#pragma once

#include <array>
#include <vector>

#include "camera/setup/film_region.h"

namespace petzval::apps {

struct PilotPixel {
    std::array<int, 2> pixel;
    double weight;         ///< share of the frame that it stands for
    bool certain = false;  ///< it was not drawn: every pixel like it is sampled
};

/// Value of each cell of a grid over the frame, row by row.
struct FilmMap {
    V2i cells{1, 1};
    std::vector<double> values{1.};

    /// Index of the cell that a pixel lies in.
    [[nodiscard]] size_t cell_at(V2i size_px, int x, int y) const {
        const auto i = static_cast<size_t>(int64_t{x} * cells.x / size_px.x),
                   j = static_cast<size_t>(int64_t{y} * cells.y / size_px.y);
        return j * static_cast<size_t>(cells.x) + i;
    }
    [[nodiscard]] double at(V2i size_px, int x, int y) const {
        return values[cell_at(size_px, x, y)];
    }
};

struct PilotPixels {
    std::vector<PilotPixel> pixels;
    /// Pixels expected to be drawn of each pixel: weight = 1 / (pixels of the frame * density).
    /// Above 0 everywhere; where all are certain it does not matter.
    FilmMap density;
    bool all_certain = false;
    std::vector<camera::FilmRegion> regions;  ///< those that got pilot pixels of their own

    /// 95 % upper bound of the mean error by pixels that were not sampled and differ from all that
    /// were; `most` bounds the error of one pixel. None of them was met where 3 were to be
    /// expected: Hanley and Lippman-Hand 1983, "If nothing goes wrong, is everything all right?",
    /// JAMA 249(13).
    [[nodiscard]] double unseen(V2i size_px, const FilmMap& most) const;
};

/// One pixel in each cell of an even grid, about `wanted` in all.
[[nodiscard]] PilotPixels even_pilot_pixels(V2i size_px, int wanted, uint32_t seed);

/// About `wanted` pilot pixels: half evenly, a quarter in the regions, to equal parts, and a
/// quarter in proportion to `emphasis`, which must be above 0 somewhere. All pixels, where the
/// frame has no more. Regions that have no more pixels than their part are sampled wholly; where
/// there are more regions than looks for them, the largest get none. They follow from the arguments
/// alone.
[[nodiscard]] PilotPixels choose_pilot_pixels(V2i size_px, int wanted,
                                              std::vector<camera::FilmRegion> regions,
                                              const FilmMap& emphasis, uint32_t seed);

}  // namespace petzval::apps
