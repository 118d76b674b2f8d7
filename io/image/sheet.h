// SPDX-License-Identifier: Apache-2.0
// Contact sheets: small pictures side by side, each with its label.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/image/reduce.h"
#include "io/image/sheet_layout.h"
#include "io/picture/picture.h"

namespace petzval::io {

inline constexpr Colour8 kSheetGround{38, 38, 38};      ///< between and behind the pictures
inline constexpr Colour8 kSheetMissing{64, 64, 64};     ///< in place of a picture
inline constexpr Colour8 kSheetLetters{214, 214, 214};  ///< of labels

/// Checks early, before hours of work, that a sheet can be written there: the ending of its name,
/// its folder, and the font. Throws InputError, which says what to do.
void check_sheet(const std::filesystem::path&, const SheetOptions&);

/// Cell of a sheet.
struct SheetCell {
    std::string label;
    std::optional<Picture8> picture;  ///< absent: it is missing
};

/// A contact sheet that gets its pictures one after the other, row by row from the left. It keeps
/// of each no more than its cell, reduced, with 8 bits a channel.
class ContactSheet {
  public:
    /// Sheet for so many pictures. Throws std::invalid_argument for none.
    explicit ContactSheet(size_t pictures, SheetOptions options = {});

    /// Chooses columns and cells for pictures of this size, as add() does by its first picture.
    /// Throws InputError where that sheet would be too large: before the pictures are made.
    void expect(int width_px, int height_px);
    /// Adds the next picture: display-encoded R, G, B (and A, unassociated) in [0, 1]. One that is
    /// narrower than its cell is not enlarged.
    void add(const PictureRows& display, const std::string& label);
    /// Adds a cell that says that its picture is missing.
    void add_missing(const std::string& label);

    /// Writes what there is, as .png or .jpg: one cell at least. Rows without any are left out.
    /// srgb: as for write_8bit(). Throws InputError, also where the sheet is too large.
    void write(const std::filesystem::path&, bool srgb = true) const;

  private:
    void append(SheetCell);

    size_t pictures_;
    SheetOptions options_;
    std::optional<SheetLayout> layout_;  ///< known with the first picture
    std::vector<SheetCell> cells_;
};

}  // namespace petzval::io
