// SPDX-License-Identifier: Apache-2.0
#include "io/image/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/file/atomic_file.h"
#include "io/image/canvas.h"
#include "io/image/label.h"
#include "io/image/picture_files.h"

namespace petzval::io {
namespace {

/// Many programs count a picture's rows with 16 bits; a JPEG has JPEG_MAX_DIMENSION of libjpeg.
constexpr int64_t kLargestSide_px = 65535, kLargestJpegSide_px = 65500;

void check_size(const std::string& sheet, const SheetSize& size, int64_t most_px) {
    if (std::max(size.width_px, size.height_px) <= most_px) return;
    throw InputError(sheet, "",
                     "would be {}x{} pixels, and a contact sheet has {} on a side at "
                     "most; take smaller pictures, or fewer",
                     size.width_px, size.height_px, most_px);
}

/// Finished cells and where they lie.
class Drawing {
  public:
    Drawing(const std::vector<SheetCell>& cells, const SheetLayout& layout, const SheetOptions& o)
        : cells_(cells), layout_(layout), font_(o.font) {
        const auto columns = size_t(layout.columns);
        std::vector<int> heights((cells.size() + columns - 1) / columns);
        std::vector<std::string> labels;
        cell_width_ = std::max(o.cell_width_px, kLeastCellWidth_px);
        for (size_t i = 0; i < cells.size(); ++i) {
            cell_width_ = std::max(cell_width_, width(cells[i]));
            heights[i / columns] = std::max(heights[i / columns], height(cells[i]));
            labels.push_back(cells[i].label);
        }
        label_ = label_size(cell_width_);
        letter_px_ = fitting_letters_px(labels, label_.letter_px, cell_width_, font_);
        for (const int h : heights)
            ends_.push_back((ends_.empty() ? 0 : ends_.back()) + kSheetGap_px + h +
                            label_.strip_px);
    }

    [[nodiscard]] SheetSize size() const {
        return {sheet_width(layout_.columns, cell_width_), ends_.back() + kSheetGap_px};
    }
    /// Rows of the sheet, which are drawn cell row by cell row as they are asked for.
    [[nodiscard]] PictureRows rows() const {
        PictureLayout sheet;
        sheet.width = sheet.full_width = int(size().width_px);
        sheet.height = sheet.full_height = int(size().height_px);
        sheet.channels = {"R", "G", "B"};
        return {sheet, [this, drawn = ends_.size() + 1, canvas = Canvas(0, 0, kSheetGround)](
                           int y, float* row) mutable {
                    const auto at =
                        size_t(std::upper_bound(ends_.begin(), ends_.end(), y) - ends_.begin());
                    if (at != drawn) canvas = row_of_cells(drawn = at);
                    canvas.read(int(y - begin(at)), row);
                }};
    }

  private:
    [[nodiscard]] int width(const SheetCell& cell) const {
        return cell.picture ? cell.picture->width : layout_.width_px;
    }
    [[nodiscard]] int height(const SheetCell& cell) const {
        return cell.picture ? cell.picture->height : layout_.height_px;
    }
    [[nodiscard]] int64_t begin(size_t row) const { return row == 0 ? 0 : ends_[row - 1]; }
    [[nodiscard]] Picture letters(const std::string& text) const {
        return fitting_label(text, letter_px_, cell_width_, font_);
    }

    /// A row of cells and the gap above it; of the row behind the last one only the gap.
    [[nodiscard]] Canvas row_of_cells(size_t row) const {
        const int sheet_width = int(size().width_px);
        if (row == ends_.size()) return {sheet_width, kSheetGap_px, kSheetGround};
        const int canvas_height = int(ends_[row] - begin(row));
        const int bottom = canvas_height - label_.strip_px;
        Canvas canvas(sheet_width, canvas_height, kSheetGround);
        const auto columns = size_t(layout_.columns);
        for (size_t i = row * columns; i < std::min((row + 1) * columns, cells_.size()); ++i) {
            const SheetCell& cell = cells_[i];
            const int left = kSheetGap_px + int(i % columns) * (cell_width_ + kSheetGap_px);
            const int middle = left + cell_width_ / 2, x = left + (cell_width_ - width(cell)) / 2;
            const int y = bottom - height(cell);
            if (cell.picture) {
                canvas.put(*cell.picture, x, y);
            } else {
                canvas.fill(x, y, width(cell), height(cell), kSheetMissing);
                canvas.put_letters(letters("missing"), middle, (y + bottom) / 2, kSheetLetters);
            }
            canvas.put_letters(letters(cell.label), middle, bottom + label_.base_line_px,
                               kSheetLetters);
        }
        return canvas;
    }

    const std::vector<SheetCell>& cells_;
    SheetLayout layout_;
    std::filesystem::path font_;
    int cell_width_ = 0, letter_px_ = 0;
    LabelSize label_{};
    std::vector<int64_t> ends_;  ///< of the rows of cells, from the top of the sheet
};

}  // namespace

void check_sheet(const std::filesystem::path& path, const SheetOptions& o) {
    if (picture_format(path) == PictureFormat::Exr)
        throw InputError(path.string(), "", "a contact sheet is written as .png, .jpg or .jpeg");
    std::error_code error;
    if (!std::filesystem::exists(o.font, error))
        throw InputError(o.font.string(), "",
                         "is not there, and the labels of a contact sheet are drawn with it; "
                         "install Debian's package fonts-dejavu-core");
    static_cast<void>(draw_text("f", label_size(0).letter_px, o.font));
    check_writable(path);
}

ContactSheet::ContactSheet(size_t pictures, SheetOptions options)
    : pictures_(pictures), options_(std::move(options)) {
    if (pictures == 0) throw std::invalid_argument("a contact sheet shows a picture at least");
}

void ContactSheet::expect(int width_px, int height_px) {
    layout_ = sheet_layout(pictures_, options_, width_px, height_px);
    check_size("the contact sheet", size_of(*layout_, options_), kLargestSide_px);
}

void ContactSheet::append(SheetCell cell) {
    if (cells_.size() == pictures_)
        throw std::invalid_argument("more pictures than the contact sheet is made for");
    cell.label = visible(cell.label);
    cells_.push_back(std::move(cell));
}

void ContactSheet::add(const PictureRows& display, const std::string& label) {
    const int width = display.layout.width, height = display.layout.height;
    if (!layout_) layout_ = sheet_layout(pictures_, options_, width, height);
    const int kept = std::min(width, layout_->most_width_px);
    append({label, reduced(display, kept, height_at(kept, width, height), kSheetGround)});
}

void ContactSheet::add_missing(const std::string& label) {
    append({label, {}});
}

void ContactSheet::write(const std::filesystem::path& path, bool srgb) const {
    if (cells_.empty()) throw std::invalid_argument("a contact sheet shows a picture at least");
    constexpr int kUnknownWidth_px = 240, kUnknownHeight_px = 160;
    const Drawing drawing(
        cells_,
        layout_ ? *layout_ : sheet_layout(pictures_, options_, kUnknownWidth_px, kUnknownHeight_px),
        options_);
    check_size(path.string(), drawing.size(),
               picture_format(path) == PictureFormat::Jpeg ? kLargestJpegSide_px : kLargestSide_px);
    write_8bit(path, drawing.rows(), srgb);
}

}  // namespace petzval::io
