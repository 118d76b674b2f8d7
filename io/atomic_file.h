// SPDX-License-Identifier: Apache-2.0
// Files that are either whole or not there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace petzval {

/// Writes the bytes to a temporary file beside the target, syncs it and renames it over the target:
/// on any error the target is as it was and nothing else is left behind. A link is followed, the
/// permissions of a file that is replaced are kept. Pipes and devices (/dev/stdout, /dev/null) are
/// written to directly. Throws InputError with the system's reason.
void write_file_atomically(const std::filesystem::path&, std::span<const uint8_t> bytes);
void write_file_atomically(const std::filesystem::path&, std::string_view text);

/// Throws what write_file_atomically would throw for a missing or locked folder, a folder in the
/// place of the file, or a file that must not be changed: to be asked before hours of work.
void check_writable(const std::filesystem::path&);

}  // namespace petzval
