// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace petzval {

/// Path of a file that is installed with this program, from its path relative to the program's
/// folder. The file need not be there. Empty where the program's own path is not known.
[[nodiscard]] std::filesystem::path file_beside_program(const std::filesystem::path& relative);

}  // namespace petzval
