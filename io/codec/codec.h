// SPDX-License-Identifier: Apache-2.0
// The functions of ImageCodec, each where its file has it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/texture.h"
#include "io/picture/colour_remarks.h"
#include "io/picture/picture.h"
#include "io/picture/picture_budget.h"

// A namespace of its own: io/image has functions of the same names, and the linker of a program
// that exports its symbols would take those for these.
namespace petzval::io::codec {

[[nodiscard]] Picture read_picture(const std::filesystem::path&, PictureBudget&,
                                   std::optional<uint64_t> kept_per_pixel);
[[nodiscard]] Metadata read_metadata(const std::filesystem::path&);
[[nodiscard]] Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                                 const std::string& place, PictureBudget&, ColourRemarks&);
void write_exr(const std::filesystem::path&, const PictureRows&);
void write_8bit(const std::filesystem::path&, const PictureRows& encoded, bool srgb);
[[nodiscard]] Picture draw_text(const std::string& utf8, int letter_px,
                                const std::filesystem::path& font);

/// Start of the names of metadata that PNG and JPEG carry too, in their description: "NAME=VALUE"
/// with a blank between two.
inline constexpr std::string_view kOwnMetadata = "petzval:";

/// Whether libjpeg said that the file ends early. OpenImageIO still calls such a picture read, grey
/// where it is missing; libjpeg's other warnings do no harm.
[[nodiscard]] inline bool is_cut_short(const std::string& message) {
    return message.find("Premature end") != std::string::npos;
}

}  // namespace petzval::io::codec
