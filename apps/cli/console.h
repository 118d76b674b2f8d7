// SPDX-License-Identifier: Apache-2.0
// Lines on stderr, for a person or a program that watches it.
#pragma once

#include <string>

namespace petzval {

/// Prints one line on stderr: control characters, which names of files may hold, become '?'. Never
/// throws: where stderr cannot be written there is nobody to tell.
void print_error_line(std::string line) noexcept;

enum class NoticeStyle { Text, Json, None };

/// Prints a notice: "petzval: TEXT", or {"notice": "TEXT"}, or nothing.
void print_notice(NoticeStyle, const std::string& text);

}  // namespace petzval
