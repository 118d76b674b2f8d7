// SPDX-License-Identifier: Apache-2.0
// Messages of libraries may have several lines; ours have one.
#pragma once

#include <string>

namespace petzval {

/// text up to its first line break.
[[nodiscard]] inline std::string first_line(const std::string& text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace petzval
