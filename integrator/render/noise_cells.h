// SPDX-License-Identifier: Apache-2.0
// Cells of a frame, in each of which a noise is to be reached.
#pragma once

#include "core/film/film.h"

namespace petzval::integrator {

/// Cells of kCell_px x kCell_px pixels, or a little more, that fill a frame.
struct NoiseCells {
    V2i frame_px{0, 0};

    static constexpr int kCell_px = 16;

    /// Number of cells along each side; a frame smaller than a cell is one.
    [[nodiscard]] V2i cells() const;
    [[nodiscard]] Rect cell(int i, int j) const;
    /// Numbers of the cells that a crop touches: first.x .. last.x - 1, ...
    [[nodiscard]] Rect cells_of(const Rect& crop) const;
    /// The smallest crop of whole cells that holds another.
    [[nodiscard]] Rect whole_cells(const Rect& crop) const;
};

}  // namespace petzval::integrator
