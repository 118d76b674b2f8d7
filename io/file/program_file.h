// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace petzval::io {

/// Path of a file that is installed with Petzval, from its path relative to the folder of programs.
/// It lies in the installation that a program of others found by find_package(Petzval), or that
/// Python's module belongs to; else beside this program. The file need not be there. Throws
/// InputError where the program does not know its own place.
[[nodiscard]] std::filesystem::path installed_file(const std::filesystem::path& relative);

}  // namespace petzval::io
