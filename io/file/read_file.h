// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::io {

/// A regular file that is open for reading: the one door through which files come in. Pipes and
/// devices are refused: they may never end. So are empty files, and what a download left in a
/// file's place. What a library opens by its name passes here first.
class InputFile {
  public:
    explicit InputFile(const std::filesystem::path&);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    /// Why it cannot be read, e.g. "no such file"; empty where it can.
    [[nodiscard]] const std::string& error() const { return error_; }
    /// Size in bytes, when it was opened.
    [[nodiscard]] uint64_t size() const { return size_; }
    /// Reads what lies from offset on; the number of bytes that there were.
    [[nodiscard]] size_t read(std::span<uint8_t> to, uint64_t offset) const;

  private:
    int descriptor_ = -1;
    uint64_t size_ = 0;
    std::string error_;
};

/// Whether the bytes are those of a text, in ASCII or UTF-8: they hold no control characters.
[[nodiscard]] bool is_text(std::string_view);

/// A file's bytes, or why there are none.
struct FileBytes {
    std::vector<uint8_t> bytes;
    std::string error;  ///< empty, or as InputFile has it
};

/// Reads a whole file.
[[nodiscard]] FileBytes read_file(const std::filesystem::path&);

/// Whether a file lies in a folder or below it, all links followed; one that does not exist counts
/// by where it would be.
[[nodiscard]] bool lies_within(const std::filesystem::path& file,
                               const std::filesystem::path& folder);

/// FNV-1a hash of 64 bits, continued from `hash` (Fowler, Noll, Vo 1991; constants of RFC 9923).
[[nodiscard]] uint64_t fnv1a(std::span<const uint8_t> bytes, uint64_t hash = 0xCBF29CE484222325u);

/// Metadata text of a file that a picture follows from: its name without folders, as equal renders
/// in other folders are equal files, and the FNV-1a of its bytes. The path itself where there is no
/// such file.
[[nodiscard]] std::string name_and_hash(const std::filesystem::path&);

}  // namespace petzval::io
