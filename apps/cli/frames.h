// SPDX-License-Identifier: Apache-2.0
// Frames of a sequence, and the names of their files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace petzval {

/// Numbers of frames from "1:48" (both are rendered), "1:48:2" (every second one) or "7": whole
/// numbers from 0, at most 100,000 of them. Throws CLI::ValidationError.
[[nodiscard]] std::vector<int> parse_frames(const std::string& option, const std::string& text);

/// Name of a frame's file: the last run of # becomes the number, with zeros up to its length.
/// Throws CLI::ValidationError where there is no # but several frames.
[[nodiscard]] std::filesystem::path name_of_frame(const std::string& option,
                                                  const std::filesystem::path&, int frame,
                                                  bool several);

}  // namespace petzval
