// SPDX-License-Identifier: Apache-2.0
// Interface of the module io/codec, as io/image sees it.
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

namespace petzval::io {

/// Functions of the module: those of the same names in io/image/picture_files.h.
struct ImageCodec {
    const char* version;  ///< of the program that it was built with: of that alone it is a part
    Picture (*read_picture)(const std::filesystem::path&, PictureBudget&,
                            std::optional<uint64_t> kept_per_pixel);
    Metadata (*read_metadata)(const std::filesystem::path&);
    Image (*decode_image)(const std::vector<uint8_t>& bytes, const std::string& file,
                          const std::string& place, PictureBudget&, ColourRemarks&);
    void (*write_exr)(const std::filesystem::path&, const PictureRows&);
    void (*write_8bit)(const std::filesystem::path&, const PictureRows& encoded, bool srgb);
    Picture (*draw_text)(const std::string& utf8, int letter_px, const std::filesystem::path& font);
    void (*limit_threads)(int threads);
};

/// Name of the module's one symbol, a function without arguments that returns an ImageCodec.
inline constexpr const char* kImageCodecSymbol = "petzval_image_codec";

}  // namespace petzval::io
