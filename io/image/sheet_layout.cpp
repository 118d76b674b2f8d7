// SPDX-License-Identifier: Apache-2.0
#include "io/image/sheet_layout.h"

#include <algorithm>
#include <cmath>

namespace petzval::io {
namespace {

SheetLayout with_columns(int columns, size_t pictures, const SheetOptions& o, int width_px,
                         int height_px) {
    SheetLayout layout;
    layout.columns = columns;
    layout.rows = int((pictures + size_t(columns) - 1) / size_t(columns));
    layout.most_width_px = o.cell_width_px;
    if (o.cell_width_px == 0)
        layout.most_width_px = std::max(
            (kUsualSheetWidth_px - kSheetGap_px) / columns - kSheetGap_px, kLeastCellWidth_px);
    layout.width_px = std::min(width_px, layout.most_width_px);
    layout.height_px = height_at(layout.width_px, width_px, height_px);
    return layout;
}

/// How far a sheet is from a square: 0 for one.
double oblongness(const SheetLayout& layout, const SheetOptions& o) {
    const SheetSize size = size_of(layout, o);
    return std::fabs(std::log(double(size.width_px) / double(size.height_px)));
}

}  // namespace

LabelSize label_size(int cell_width_px) {
    constexpr int kLeast_px = 12, kMost_px = 40, kCellsWidth = 20;
    const int letter = std::clamp(cell_width_px / kCellsWidth, kLeast_px, kMost_px);
    // A letter has about 0.93 of its size above the base line, and 0.24 below.
    return {letter, letter * 3 / 2, letter * 6 / 5};
}

int height_at(int new_width_px, int width_px, int height_px) {
    const double scale = double(new_width_px) / width_px;
    return std::clamp(int(std::lround(height_px * scale)), 1, height_px);
}

int64_t sheet_width(int columns, int cell_width_px) {
    return int64_t{columns} * (cell_width_px + kSheetGap_px) + kSheetGap_px;
}

SheetSize size_of(const SheetLayout& layout, const SheetOptions& o) {
    const int cell = std::max({o.cell_width_px, layout.width_px, kLeastCellWidth_px});
    const int row = kSheetGap_px + layout.height_px + label_size(cell).strip_px;
    return {sheet_width(layout.columns, cell), int64_t{layout.rows} * row + kSheetGap_px};
}

SheetLayout sheet_layout(size_t pictures, const SheetOptions& o, int picture_width_px,
                         int picture_height_px) {
    const int most = int(std::min<size_t>(pictures, 65536));
    const auto with = [&](int columns) {
        return with_columns(columns, pictures, o, picture_width_px, picture_height_px);
    };
    if (o.columns > 0) return with(std::min(o.columns, most));
    SheetLayout best = with(1);
    for (int columns = 2; columns <= most; ++columns)
        if (const SheetLayout next = with(columns); oblongness(next, o) < oblongness(best, o))
            best = next;
    return best;
}

}  // namespace petzval::io
