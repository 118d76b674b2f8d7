// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/noise_cells.h"

#include <algorithm>
#include <cstdint>

namespace petzval::integrator {
namespace {

/// Cell of a pixel along a side: edges lie at side * i / cells.
int cell_at(int px, int side_px, int cells) {
    return static_cast<int>((int64_t{px} * cells + cells - 1) / side_px);
}

}  // namespace

V2i NoiseCells::cells() const {
    return {std::max(1, frame_px.x / kCell_px), std::max(1, frame_px.y / kCell_px)};
}

Rect NoiseCells::cell(int i, int j) const {
    const V2i n = cells();
    return {frame_px.x * i / n.x, frame_px.y * j / n.y, frame_px.x * (i + 1) / n.x,
            frame_px.y * (j + 1) / n.y};
}

Rect NoiseCells::cells_of(const Rect& crop) const {
    const V2i n = cells();
    Rect out{cell_at(crop.x0, frame_px.x, n.x), cell_at(crop.y0, frame_px.y, n.y), 0, 0};
    // A cell holds a pixel if it begins at it or before.
    while (out.x0 > 0 && cell(out.x0, 0).x0 > crop.x0) --out.x0;
    while (out.y0 > 0 && cell(0, out.y0).y0 > crop.y0) --out.y0;
    out.x1 = out.x0 + 1, out.y1 = out.y0 + 1;
    while (out.x1 < n.x && cell(out.x1, 0).x0 < crop.x1) ++out.x1;
    while (out.y1 < n.y && cell(0, out.y1).y0 < crop.y1) ++out.y1;
    return out;
}

Rect NoiseCells::whole_cells(const Rect& crop) const {
    const Rect n = cells_of(crop), first = cell(n.x0, n.y0), last = cell(n.x1 - 1, n.y1 - 1);
    return {first.x0, first.y0, last.x1, last.y1};
}

}  // namespace petzval::integrator
