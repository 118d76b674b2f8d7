// SPDX-License-Identifier: Apache-2.0
#include "io/file/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "io/base/ascii.h"
#include "io/base/machine.h"
#include "io/file/text_lines.h"

namespace petzval::io {
namespace {

/// Size of file for which nobody need be asked whether there is memory.
constexpr uint64_t kSurelyThere_bytes = 64 << 20;

/// What lies where a download went wrong, by how it begins, in small letters. Git LFS: its
/// docs/spec.md, "The Pointer".
struct StandIn {
    std::string_view begin, what;
};
constexpr std::array<StandIn, 2> kStandIns{
    {{"version https://git-lfs.github.com/spec/",
      "is only a pointer of Git LFS; git lfs pull fetches the file itself"},
     {"<!doctype html", "is a web page; download the file itself"}}};

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) {
    struct stat status {};
    const auto refuse_others = [&] {
        if (S_ISDIR(status.st_mode))
            error_ = "is a folder";
        else if (!S_ISREG(status.st_mode))
            error_ = "is not a regular file";
        return !error_.empty();
    };
    const auto refuse = [&] {
        error_ = errno == ENOENT || errno == ENOTDIR ? "no such file" : std::strerror(errno);
    };
    // Before it is opened, which may act on a device, and after it: it may be another one by now.
    if (::stat(path.c_str(), &status) != 0) refuse();
    if (!error_.empty() || refuse_others()) return;
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0)
        refuse();
    else if (!refuse_others())
        size_ = static_cast<uint64_t>(status.st_size);
    if (error_.empty() && size_ == 0) error_ = "is empty";
    std::array<uint8_t, 64> head{};
    const std::string start = lower({head.begin(), head.begin() + std::ptrdiff_t(read(head, 0))});
    for (const StandIn& one : kStandIns)
        if (trimmed(start).starts_with(one.begin)) error_ = one.what;
}

InputFile::~InputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

size_t InputFile::read(std::span<uint8_t> to, uint64_t offset) const {
    size_t done = 0;
    while (error_.empty() && done < to.size()) {
        const ssize_t count = ::pread(descriptor_, to.data() + done, to.size() - done,
                                      static_cast<off_t>(offset + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        done += static_cast<size_t>(count);
    }
    return done;
}

bool is_text(std::string_view bytes) {
    return std::ranges::none_of(bytes, [](unsigned char c) {
        return c == 0x7F || (c < ' ' && c != '\t' && c != '\r' && c != '\n');
    });
}

FileBytes read_file(const std::filesystem::path& path) {
    const InputFile in(path);
    if (!in.error().empty()) return {{}, in.error()};
    if (in.size() > kSurelyThere_bytes && in.size() > usable_memory_bytes())
        return {{},
                fmt::format("has {} MiB, more than the memory that can be had", in.size() >> 20)};
    FileBytes file;
    file.bytes.resize(in.size());
    if (in.read(file.bytes, 0) != in.size()) return {{}, "cannot be read to its end"};
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

}  // namespace petzval::io
