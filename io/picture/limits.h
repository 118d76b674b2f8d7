// SPDX-License-Identifier: Apache-2.0
// Limits on the size of pictures: a small file must not ask for gigabytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace petzval::io {

/// Reason why a file of byte_count bytes cannot hold such a picture; empty where it can.
[[nodiscard]] std::string size_complaint(int width, int height, int depth, int channels,
                                         uint64_t byte_count);

/// Width and height that a WebP file announces in its first 30 bytes; nothing where it is none.
/// OpenImageIO decodes such a file when it opens it, before its size is known. RFC 9649, section 2;
/// RFC 6386, section 9.1.
[[nodiscard]] std::optional<std::array<int, 2>> webp_size(std::span<const uint8_t> file);

}  // namespace petzval::io
