// SPDX-License-Identifier: Apache-2.0
// Pictures in memory.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace petzval::io {

/// Metadata of a picture, name by name.
using Metadata = std::vector<std::pair<std::string, std::variant<int, float, std::string>>>;

/// Layout of a picture: size, place, channels and metadata, without the pixels.
struct PictureLayout {
    int width = 0, height = 0;            ///< of the pixels held (a crop)
    int x = 0, y = 0;                     ///< where they lie in the full frame
    int full_width = 0, full_height = 0;  ///< the full frame
    std::vector<std::string> channels;    ///< "R", "G", "B", "A", "albedo.R", "depth.Z" ...
    Metadata metadata;
};

/// Picture with float pixels, row 0 at the top, channels interleaved, linear.
struct Picture : PictureLayout {
    std::vector<float> pixels;
    /// Whether a file held whole numbers, as PNG and JPEG do: values for a display, not light.
    bool for_display = false;
};

/// A picture whose rows are made when they are asked for: those of a spectral film would not fit
/// into memory beside it.
struct PictureRows {
    PictureLayout layout;
    /// Fills row y (0 is the top one of those held): width times the channels.
    std::function<void(int y, float* row)> row;

    PictureRows(PictureLayout l, std::function<void(int, float*)> r)
        : layout(std::move(l)), row(std::move(r)) {}
    /// The rows of a picture, which must outlive this. Throws std::invalid_argument where its
    /// pixels do not match its size and channels.
    PictureRows(const Picture&);
};

/// Index of the channel of that name among a picture's channels; -1 where there is none.
[[nodiscard]] int channel_index(const PictureLayout&, std::string_view name);

}  // namespace petzval::io
