// SPDX-License-Identifier: Apache-2.0
// Files that come with the program.
#pragma once

#include <filesystem>
#include <string>

namespace petzval {

/// Path of an asset: relative to the running program if that is an installed one, else in the
/// source tree it was built from. relative: "color/config.ocio". Throws InputError if in neither.
[[nodiscard]] std::filesystem::path asset(const std::string& relative);

}  // namespace petzval
