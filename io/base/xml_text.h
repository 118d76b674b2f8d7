// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/base/printable.h"

namespace petzval::io {

/// Text for XML and HTML, in elements and attributes; every character of it shows (visible()).
[[nodiscard]] inline std::string xml_text(std::string_view text) {
    std::string out;
    for (const char c : visible(text))
        out += c == '&'   ? "&amp;"
               : c == '<' ? "&lt;"
               : c == '>' ? "&gt;"
               : c == '"' ? "&quot;"
                          : std::string(1, c);
    return out;
}

}  // namespace petzval::io
