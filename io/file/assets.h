// SPDX-License-Identifier: Apache-2.0
// Files that come with the program.
#pragma once

#include <filesystem>
#include <string>

namespace petzval::io {

/// Path of an asset, of which that in the folder assets is relative: "color/config.ocio". Throws
/// InputError where it is missing.
[[nodiscard]] std::filesystem::path asset(const std::string& relative);

}  // namespace petzval::io
