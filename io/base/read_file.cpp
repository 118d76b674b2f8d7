// SPDX-License-Identifier: Apache-2.0
#include "io/base/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "io/base/machine.h"

namespace petzval {

/// Size of file for which nobody need be asked whether there is memory.
constexpr uintmax_t kSurelyThere_bytes = 64 << 20;

FileBytes read_file(const std::filesystem::path& path) {
    namespace fs = std::filesystem;
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (status.type() == fs::file_type::not_found) return {{}, "no such file"};
    if (code) return {{}, code.message()};
    if (status.type() == fs::file_type::directory) return {{}, "is a folder"};
    if (status.type() != fs::file_type::regular) return {{}, "is not a regular file"};

    const uintmax_t size = fs::file_size(path, code);
    if (code) return {{}, code.message()};
    if (size > kSurelyThere_bytes && size > usable_memory_bytes())
        return {{}, fmt::format("has {} MiB, more than the memory that can be had", size >> 20)};
    std::ifstream in(path, std::ios::binary);
    if (!in) return {{}, "cannot be opened"};
    FileBytes file;
    file.bytes.resize(size);
    in.read(reinterpret_cast<char*>(file.bytes.data()), std::streamsize(size));
    if (uintmax_t(in.gcount()) != size) return {{}, "cannot be read to its end"};
    return file;
}

bool lies_within(const std::filesystem::path& file, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path top = fs::canonical(folder.empty() ? "." : folder, error);
    if (error) return false;
    // Absolute first: what does not exist at all would stay relative.
    const fs::path real = fs::weakly_canonical(fs::absolute(file, error), error);
    if (error) return false;
    return std::mismatch(top.begin(), top.end(), real.begin(), real.end()).first == top.end();
}

uint64_t fnv1a(std::span<const uint8_t> bytes, uint64_t hash) {
    for (uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001B3u;
    return hash;
}

std::string name_and_hash(const std::filesystem::path& path) {
    const FileBytes file = read_file(path);
    if (!file.error.empty()) return path.string();
    return fmt::format("{} ({:016x})", path.filename().string(), fnv1a(file.bytes));
}

}  // namespace petzval
