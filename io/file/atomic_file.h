// SPDX-License-Identifier: Apache-2.0
// Files that are either whole or not there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace petzval::io {

/// A file that takes the place of its target, with the permissions of a file that was there, once
/// it is committed; before, the target is as it was. Where the file system can, it has no name
/// until then, so that nothing is left behind even by a process that is killed. A link is followed.
/// Output for pipes and devices (/dev/stdout, /dev/null) waits in a file in /tmp.
class AtomicFile {
  public:
    /// Throws OutputError, with the system's reason, where the file could not be put in place.
    explicit AtomicFile(const std::filesystem::path& target);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Writes at any place, in any order. The first failure is kept for commit(), and nothing is
    /// written after it: libraries that encode pictures do not get along with failing writes.
    void write(std::span<const uint8_t> bytes, uint64_t offset) noexcept;
    /// Reads what was written from an offset on; the number of bytes that there were.
    size_t read(std::span<uint8_t> to, uint64_t offset) noexcept;
    /// Syncs and puts the file in place. Throws OutputError with the system's reason, also for a
    /// failed write.
    void commit();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Writes a whole file through AtomicFile. Throws OutputError with the system's reason.
void write_file_atomically(const std::filesystem::path&, std::span<const uint8_t> bytes);
void write_file_atomically(const std::filesystem::path&, std::string_view text);

/// Whether a path is a pipe, a terminal, a device or a standard stream: nothing is renamed over it.
[[nodiscard]] bool is_stream(const std::filesystem::path&);

/// Checks early, before hours of work, that a file can be written. Throws what AtomicFile would
/// throw for a missing or locked folder, a folder in the place of the file, or a file that must not
/// be changed.
void check_writable(const std::filesystem::path&);

}  // namespace petzval::io
