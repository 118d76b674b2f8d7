// SPDX-License-Identifier: Apache-2.0
// Writing what took hours to make: where a file cannot be written, a copy goes somewhere else.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace petzval::io {

/// Outcome of writing a file.
struct WriteOutcome {
    std::filesystem::path wanted;
    std::string error;             ///< why it could not be written; empty where it was
    std::filesystem::path rescue;  ///< where a copy lies instead; empty where there is none

    [[nodiscard]] bool written() const { return error.empty(); }
    /// The error with where the copy is, or that there is none; one line.
    [[nodiscard]] std::string message() const;
};

/// Writes a file by write(path). Where that throws, the same goes to NAME.rescue.EXT in the folder
/// of the file, else in the current folder, else in a new folder of the temporary one; no file that
/// is there already is touched. Throws nothing itself.
[[nodiscard]] WriteOutcome write_or_rescue(
    const std::filesystem::path&, const std::function<void(const std::filesystem::path&)>& write);

/// Runs every action, whichever of them throw; then throws what one of them threw, or an
/// OutputError with the messages of several. A file that cannot be written does not lose those
/// after it.
void attempt_all(const std::vector<std::function<void()>>& actions);

}  // namespace petzval::io
