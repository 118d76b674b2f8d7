// SPDX-License-Identifier: Apache-2.0
// Pictures on disk: EXR, Radiance, PNG, JPEG and WebP in (io/image/picture_kind.h), EXR, PNG and
// JPEG out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/scene/texture.h"
#include "io/image/picture_budget.h"

namespace petzval {

/// Layout of a picture: size, place, channels and metadata, without the pixels.
struct PictureLayout {
    int width = 0, height = 0;            ///< of the pixels held (a crop)
    int x = 0, y = 0;                     ///< where they lie in the full frame
    int full_width = 0, full_height = 0;  ///< the full frame
    std::vector<std::string> channels;    ///< "R", "G", "B", "A", "albedo.R", "depth.Z" ...
    std::vector<std::pair<std::string, std::variant<int, float, std::string>>> metadata;
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

/// Reads every channel as floats; converts nothing but integers, to [0, 1]. kept_per_pixel: bytes
/// that the caller keeps of each pixel beside the floats, which it then drops; absent where it
/// keeps the floats. Throws InputError, also where the budget is too small.
[[nodiscard]] Picture read_picture(const std::filesystem::path&, PictureBudget&,
                                   std::optional<uint64_t> kept_per_pixel = {});
/// Reads a picture that shares its budget, the usual one, with no other.
[[nodiscard]] Picture read_picture(const std::filesystem::path&);
/// Decodes an image of a scene from its encoded bytes; file and place are for messages. Throws
/// InputError, also where the budget is too small.
[[nodiscard]] Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                                 const std::string& place, PictureBudget&);

/// Formats of pictures that can be written. Only Exr holds scene-linear values, only Jpeg holds no
/// alpha.
enum class PictureFormat : uint8_t { Exr, Png, Jpeg };
/// Picture format by the ending of the name (.exr, .png, .jpg, .jpeg). Throws InputError for any
/// other.
[[nodiscard]] PictureFormat picture_format(const std::filesystem::path&);
/// Writes a 32-bit float EXR with every channel, all metadata, and the chromaticities of R, G and
/// B, which are those of Rec. 709 with a D65 white in every picture of this program. Equal pictures
/// give equal files: there is no date in them. Throws InputError where it cannot be written.
void write_exr(const std::filesystem::path&, const PictureRows&);
/// Writes an 8-bit PNG or JPEG of display-encoded R, G, B in [0, 1] (and, in PNG, unassociated A if
/// there is one); of a crop just the crop. srgb: the file says that its values are for an sRGB
/// display. Throws InputError where it cannot be written.
void write_8bit(const std::filesystem::path&, const PictureRows& encoded, bool srgb = true);

/// Index of the channel of that name among a picture's channels; -1 where there is none.
[[nodiscard]] int channel_index(const PictureLayout&, std::string_view name);

}  // namespace petzval
