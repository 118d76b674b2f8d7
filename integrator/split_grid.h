// SPDX-License-Identifier: Apache-2.0
// How often each part of a frame takes the difference to the split paths.
#pragma once

#include <algorithm>
#include <vector>

#include "core/film.h"

namespace petzval {

/// Cells of the full frame, whatever the crop and the tiles.
class SplitGrid {
  public:
    static constexpr int kCell_px = 16;

    /// The same probability everywhere, (0, 1].
    SplitGrid(V2i full_size, float probability)
        : across_(cells(full_size.x)),
          down_(cells(full_size.y)),
          probability_(static_cast<size_t>(across_) * down_, probability) {}

    /// The cells that a crop, not empty, touches.
    [[nodiscard]] static Rect cells_of(const Rect& crop) {
        return {crop.x0 / kCell_px, crop.y0 / kCell_px, cells(crop.x1), cells(crop.y1)};
    }
    /// One more cell on each side, where there is one.
    [[nodiscard]] Rect with_neighbours(const Rect& r) const {
        return {std::max(r.x0 - 1, 0), std::max(r.y0 - 1, 0), std::min(r.x1 + 1, across_),
                std::min(r.y1 + 1, down_)};
    }
    /// Of the cell in that column and row.
    [[nodiscard]] float& cell(int x, int y) { return probability_[index(x, y)]; }
    /// Of a pixel of the full frame.
    [[nodiscard]] float at(int x, int y) const {
        return probability_[index(x / kCell_px, y / kCell_px)];
    }

  private:
    [[nodiscard]] static int cells(int size_px) { return (size_px + kCell_px - 1) / kCell_px; }
    [[nodiscard]] size_t index(int x, int y) const { return static_cast<size_t>(y) * across_ + x; }

    int across_, down_;
    std::vector<float> probability_;
};

}  // namespace petzval
