// SPDX-License-Identifier: Apache-2.0
// Where the cells of a contact sheet lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace petzval::io {

/// How a contact sheet is to look.
struct SheetOptions {
    int columns = 0;        ///< 0: chosen so that the sheet is about as wide as high
    int cell_width_px = 0;  ///< 0: as the pictures are, but the sheet at most 3840 px wide
    std::filesystem::path font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
};

inline constexpr int kSheetGap_px = 12;           ///< between cells and around them
inline constexpr int kUsualSheetWidth_px = 3840;  ///< most that a sheet has unasked
inline constexpr int kLeastCellWidth_px = 16;     ///< so that a cell is still to be seen

/// Letters under a cell.
struct LabelSize {
    int letter_px, strip_px, base_line_px;  ///< base line: below the top of the strip
};
/// Label size for cells of that width, about a twentieth of it.
[[nodiscard]] LabelSize label_size(int cell_width_px);

/// Columns and cells for pictures of one size; others keep to the same width.
struct SheetLayout {
    int columns = 1, rows = 1;
    int most_width_px = 0;            ///< of a picture: wider ones are reduced
    int width_px = 0, height_px = 0;  ///< of the picture of that size in its cell
};
/// Layout of a sheet for so many pictures (1 or more) of a size.
[[nodiscard]] SheetLayout sheet_layout(size_t pictures, const SheetOptions&, int picture_width_px,
                                       int picture_height_px);

/// Height of a picture that is reduced to a width: at least a pixel.
[[nodiscard]] int height_at(int new_width_px, int width_px, int height_px);

/// Width of a sheet.
[[nodiscard]] int64_t sheet_width(int columns, int cell_width_px);

/// Size in pixels, which may be more than a file can have.
struct SheetSize {
    int64_t width_px, height_px;
};
/// Size of a sheet whose pictures all have the size that its layout is for.
[[nodiscard]] SheetSize size_of(const SheetLayout&, const SheetOptions&);

}  // namespace petzval::io
