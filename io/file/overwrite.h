// SPDX-License-Identifier: Apache-2.0
// Outputs that would destroy an input, or each other.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace petzval::io {

/// A file that a command reads or writes, and what it is to the user: "--env", "the scene".
struct NamedFile {
    std::string role;
    std::filesystem::path path;
};

/// Whether two paths lead to one file, through any links and spellings; also where there is no file
/// yet. Terminals and devices such as /dev/null are nobody's loss and equal to nothing.
[[nodiscard]] bool same_file(const std::filesystem::path&, const std::filesystem::path&);

/// Throws ArgumentError, which names both, where an output is the same file as an input or as
/// another output.
void refuse_overwriting(const std::vector<NamedFile>& outputs,
                        const std::vector<NamedFile>& inputs);

}  // namespace petzval::io
