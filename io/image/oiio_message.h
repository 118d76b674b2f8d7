// SPDX-License-Identifier: Apache-2.0
// Messages of OpenImageIO, in one line.
#pragma once

#include <string>

namespace petzval {

/// Text up to its first line break.
[[nodiscard]] inline std::string first_line(const std::string& text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

/// Whether libjpeg said that the file ends early. OpenImageIO still calls such a picture read, grey
/// where it is missing; libjpeg's other warnings do no harm.
[[nodiscard]] inline bool is_cut_short(const std::string& message) {
    return message.find("Premature end") != std::string::npos;
}

}  // namespace petzval
