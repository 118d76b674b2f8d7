// SPDX-License-Identifier: Apache-2.0
// Formats of picture files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace petzval::io {

/// Ending of the format that the first bytes of a file announce: "exr", "hdr", "png", "jpg" or
/// "webp"; empty for any other. These are the formats that are decoded: OpenImageIO has readers for
/// two dozen more, and a file of a stranger should not reach them.
[[nodiscard]] std::string_view picture_kind(std::string_view first_bytes);

/// As many first bytes as picture_kind() looks at.
inline constexpr size_t kPictureKindBytes = 12;

/// Formats of pictures that can be written. Only Exr holds scene-linear values, only Jpeg holds no
/// alpha.
enum class PictureFormat : uint8_t { Exr, Png, Jpeg };
/// Picture format by the ending of the name (.exr, .png, .jpg, .jpeg). Throws InputError for any
/// other.
[[nodiscard]] PictureFormat picture_format(const std::filesystem::path&);

}  // namespace petzval::io
