// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "io/base/printable.h"

namespace petzval::io {

/// Greatest nesting depth of containers: far more than any scene needs, far less than a stack
/// holds.
inline constexpr int max_json_depth = 128;

/// Parses UTF-8 JSON (RFC 8259) from a file that may be hostile: depth is limited before anything
/// recurses, a repeated key is refused (as glTF 2.0, section 2.7, demands), and so is a number
/// beyond the range of a double. A byte order mark is skipped, as RFC 8259, section 8.1, allows.
/// Whole numbers written as 3.0 become integers, so that no reader has to know both ways. file: its
/// name, for the InputError.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& file);

/// Member of an object; null where it has none of that key, or is no object.
[[nodiscard]] const nlohmann::json& member(const nlohmann::json& owner, const char* key);
/// Text of a member; empty where there is none.
[[nodiscard]] std::string text_of(const nlohmann::json& owner, const char* key);

}  // namespace petzval::io
