// SPDX-License-Identifier: Apache-2.0
// Lines on stdout and stderr, for a person or a program that watches them. Names of files, and
// names in files, may hold anything: no character of a line is hidden, and none acts on a terminal.
#pragma once

#include <string>

namespace petzval {

/// Prints one line on stderr, every character visible() (io/base/printable.h). Never throws: where
/// stderr cannot be written there is nobody to tell.
void print_error_line(std::string line) noexcept;

/// Prints one line on stdout, every character visible().
void print_line(const std::string& line);

enum class NoticeStyle { Text, Json, None };

/// Prints a notice: "petzval: TEXT", or {"notice": "TEXT"}, or nothing.
void print_notice(NoticeStyle, const std::string& text);

}  // namespace petzval
