// SPDX-License-Identifier: Apache-2.0
// Pictures on disk: EXR, Radiance, PNG, JPEG and WebP in (io/picture/picture_kind.h), EXR, PNG and
// JPEG out, and the letters that are drawn into them. The module of io/codec does the work; it is
// loaded at the first call.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/texture.h"
#include "io/picture/colour_remarks.h"
#include "io/picture/picture.h"
#include "io/picture/picture_budget.h"
#include "io/picture/picture_kind.h"

namespace petzval::io {

/// Reads every channel as floats; converts nothing but integers, to [0, 1]. kept_per_pixel: bytes
/// that the caller keeps of each pixel beside the floats, which it then drops; absent where it
/// keeps the floats. Throws InputError, also where the budget is too small.
[[nodiscard]] Picture read_picture(const std::filesystem::path&, PictureBudget&,
                                   std::optional<uint64_t> kept_per_pixel = {});
/// Reads a picture that shares its budget, the usual one, with no other.
[[nodiscard]] Picture read_picture(const std::filesystem::path&);
/// Reads the metadata of a picture alone. Of a PNG or JPEG those that this program wrote. Throws
/// InputError.
[[nodiscard]] Metadata read_metadata(const std::filesystem::path&);
/// Decodes an image of a scene from its encoded bytes; file and place are for messages. Throws
/// InputError, also where the budget is too small.
[[nodiscard]] Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                                 const std::string& place, PictureBudget&);
/// Decodes an image likewise, and says what it says of its colours.
[[nodiscard]] Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                                 const std::string& place, PictureBudget&, ColourRemarks&);

/// Writes a 32-bit float EXR with every channel, all metadata, and the chromaticities of R, G and
/// B, which are those of Rec. 709 with a D65 white in every picture of this program. Equal pictures
/// give equal files: there is no date in them. Throws InputError where it cannot be written.
void write_exr(const std::filesystem::path&, const PictureRows&);
/// Writes an 8-bit PNG or JPEG of display-encoded R, G, B in [0, 1] (and, in PNG, unassociated A if
/// there is one); of a crop just the crop. Of the metadata it keeps the texts without blanks that
/// are this program's own. srgb: the file says that its values are for an sRGB display. Throws
/// InputError where it cannot be written.
void write_8bit(const std::filesystem::path&, const PictureRows& encoded, bool srgb = true);

/// Coverage in [0, 1] of a line of letters, letter_px high, in the one channel A. x and y: where it
/// lies from the start of the base line; an empty text covers nothing. Characters that the font
/// lacks are boxes. Throws InputError where the font cannot be used.
[[nodiscard]] Picture draw_text(const std::string& utf8, int letter_px,
                                const std::filesystem::path& font);

/// Loads the module, a sixth of a second of CPU time: early, before hours of work, to learn whether
/// it can be loaded. Throws InputError where it cannot.
void load_image_codec();

/// Limits the threads that OpenEXR starts, which otherwise are as many as this process can run at
/// once (usable_threads). They do not change a byte.
void limit_picture_threads(int threads);

}  // namespace petzval::io
