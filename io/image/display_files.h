// SPDX-License-Identifier: Apache-2.0
// Files that a display transform is read from.
#pragma once

#include <filesystem>
#include <vector>

namespace petzval::io {

/// An OpenColorIO configuration, the lookup tables that its transforms name, and those that the
/// tables refer to, as far as they are there. Only the configuration where it cannot be read:
/// whoever uses it will say so.
[[nodiscard]] std::vector<std::filesystem::path> display_files(const std::filesystem::path& config);

}  // namespace petzval::io
