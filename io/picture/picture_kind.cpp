// SPDX-License-Identifier: Apache-2.0
#include "io/picture/picture_kind.h"

#include "io/base/ascii.h"
#include "io/base/error.h"

namespace petzval::io {

std::string_view picture_kind(std::string_view head) {
    using namespace std::string_view_literals;
    if (head.starts_with("\x76\x2f\x31\x01"sv)) return "exr";
    if (head.starts_with("#?")) return "hdr";
    if (head.starts_with("\x89PNG\r\n\x1a\n")) return "png";
    if (head.starts_with("\xff\xd8\xff")) return "jpg";
    if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP") return "webp";
    return "";
}

PictureFormat picture_format(const std::filesystem::path& path) {
    const std::string ending = lower(path.extension().string());
    if (ending == ".exr") return PictureFormat::Exr;
    if (ending == ".png") return PictureFormat::Png;
    if (ending == ".jpg" || ending == ".jpeg") return PictureFormat::Jpeg;
    throw ArgumentError(path.string(), "",
                        "a picture's name must end in .exr, .png, .jpg or .jpeg");
}

}  // namespace petzval::io
