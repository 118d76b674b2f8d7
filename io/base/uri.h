// SPDX-License-Identifier: Apache-2.0
// URIs as glTF uses them: a relative path to a side file, or the data itself.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::io {

/// The content of a "data:" URI (RFC 2397).
struct DataUri {
    std::string mime_type;  ///< lower case, without parameters; may be empty
    std::vector<uint8_t> bytes;
};

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// Content of a data URI; nothing when it is not base64 or the base64 is broken.
[[nodiscard]] std::optional<DataUri> parse_data_uri(std::string_view uri);

/// Decodes base64 (RFC 4648, sections 4 and 5), with or without padding and line breaks; nothing
/// when a character is foreign or the length impossible.
[[nodiscard]] std::optional<std::vector<uint8_t>> decode_base64(std::string_view text);

/// Base64 with padding (RFC 4648, section 4).
[[nodiscard]] std::string encode_base64(std::span<const uint8_t> bytes);

/// The path that a relative URI reference names, percent-escapes decoded (RFC 3986) and \ made /;
/// nothing when it has a scheme or a host, is absolute or empty, or an escape hides a zero byte.
[[nodiscard]] std::optional<std::string> relative_path(std::string_view uri);

}  // namespace petzval::io
