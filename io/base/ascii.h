// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace petzval::io {

/// Text with its ASCII letters in lower case, whatever the locale; other bytes as they are.
[[nodiscard]] inline std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

}  // namespace petzval::io
