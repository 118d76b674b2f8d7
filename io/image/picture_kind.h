// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace petzval {

/// Ending of the format that the first bytes of a file announce: "exr", "hdr", "png", "jpg" or
/// "webp"; empty for any other. These are the formats that are decoded: OpenImageIO has readers for
/// two dozen more, and a file of a stranger should not reach them.
[[nodiscard]] std::string_view picture_kind(std::string_view first_bytes);

/// As many first bytes as picture_kind() looks at.
inline constexpr size_t kPictureKindBytes = 12;

}  // namespace petzval
