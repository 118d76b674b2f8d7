// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace petzval {

/// A file's bytes, or why there are none.
struct FileBytes {
    std::vector<uint8_t> bytes;
    std::string error;  ///< empty, or e.g. "no such file"
};

/// Reads a whole file. Pipes and devices are refused: they may never end.
[[nodiscard]] FileBytes read_file(const std::filesystem::path&);

}  // namespace petzval
