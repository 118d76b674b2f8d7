// SPDX-License-Identifier: Apache-2.0
// Text of files and names, made fit to be shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace petzval::io {

struct Character {
    uint32_t code;
    size_t bytes;  ///< 0: not UTF-8
};
/// First character of a text that is not empty: RFC 3629, section 4, so without overlong forms and
/// surrogates.
[[nodiscard]] Character first_character(std::string_view);

/// Text in which every character shows. Control characters, marks of direction and characters
/// without width become escapes such as \u202e; bytes that are not UTF-8 become \xff. What a
/// terminal obeys or hides can then neither act nor deceive (Boucher and Anderson 2021, "Trojan
/// Source: Invisible Vulnerabilities").
[[nodiscard]] std::string visible(std::string_view text);

/// Text from a file made fit for a message of one line: visible(), and cut after about 80 bytes.
[[nodiscard]] std::string printable(std::string_view text);

/// Word as one of a command line, between quotes where a shell would divide or change it.
[[nodiscard]] std::string for_shell(const std::string& word);

}  // namespace petzval::io
