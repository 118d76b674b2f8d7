// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <utility>

#include "io/error.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

InputError refusal(const fs::path& path, const std::string& why) {
    return {path.string(), "", "cannot be written: " + why};
}
InputError system_refusal(const fs::path& path, int error) {
    return refusal(path, std::strerror(error));
}

/// An open file, closed when it goes.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    [[nodiscard]] int get() const { return fd_; }
    /// Error number of the last chance of some file systems to report one; 0 for none.
    [[nodiscard]] int close() { return ::close(std::exchange(fd_, -1)) == 0 ? 0 : errno; }

  private:
    int fd_;
};

/// Error number, 0 for none.
int write_all(int fd, std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) return errno;
        if (written > 0) bytes = bytes.subspan(static_cast<size_t>(written));
    }
    return 0;
}

/// Error number, 0 for none; file systems that cannot sync are no error.
int sync(int fd) {
    if (::fsync(fd) == 0 || errno == EINVAL || errno == ENOTSUP) return 0;
    return errno;
}

/// A file of its own beside the target, deleted when it goes unless it was renamed.
class TemporaryFile {
  public:
    TemporaryFile(const fs::path& folder, const fs::path& for_message);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }
    [[nodiscard]] Descriptor& file() { return *file_; }
    /// Error number, 0 for none.
    [[nodiscard]] int rename_to(const fs::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
        path_.clear();
        return 0;
    }

  private:
    fs::path path_;
    std::optional<Descriptor> file_;
};

TemporaryFile::TemporaryFile(const fs::path& folder, const fs::path& for_message) {
    std::random_device random;
    for (;;) {
        const fs::path path = folder / fmt::format(".petzval-{:08x}{:08x}", random(), random());
        const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0) {
            path_ = path;
            file_.emplace(fd);
            return;
        }
        if (errno == EEXIST || errno == EINTR) continue;
        throw refusal(for_message, fmt::format("no file can be made in the folder {}: {}",
                                               folder.string(), std::strerror(errno)));
    }
}

/// What the path leads to, through any number of links up to Linux's own limit; it may not exist.
fs::path follow_links(fs::path path) {
    constexpr int kMaxLinks = 40;
    std::error_code error;
    for (int i = 0; i < kMaxLinks; ++i) {
        if (!fs::is_symlink(path, error)) return path;
        path = path.parent_path() / fs::read_symlink(path, error);
    }
    throw system_refusal(path, ELOOP);
}

/// Pipes, terminals and devices, and standard output whatever it is: nothing to rename over.
bool is_stream(const fs::path& path, const std::optional<struct stat>& status) {
    if (status && !S_ISREG(status->st_mode)) return true;
    const std::string name = path.string();
    return name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/") ||
           name.starts_with("/proc/");
}

/// Nothing where there is no such file yet; throws where there can be none.
std::optional<struct stat> status_of(const fs::path& path) {
    if (!path.has_filename()) throw refusal(path, "it names no file");
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        if (errno == ENOENT) return std::nullopt;
        throw system_refusal(path, errno);
    }
    if (S_ISDIR(status.st_mode)) throw refusal(path, "it is a folder");
    if (::access(path.c_str(), W_OK) != 0) throw system_refusal(path, errno);
    return status;
}

fs::path folder_of(const fs::path& target, const fs::path& for_message) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(folder, error))
        throw refusal(for_message,
                      fmt::format("there is no folder {}; make it first", folder.string()));
    return folder;
}

void write_stream(const fs::path& path, std::span<const uint8_t> bytes) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC));
    if (file.get() < 0) throw system_refusal(path, errno);
    if (const int error = write_all(file.get(), bytes)) throw system_refusal(path, error);
    if (const int error = file.close()) throw system_refusal(path, error);
}

/// Owner (where that is allowed) and permissions of the file that is replaced.
int keep_rights(int fd, const struct stat& status) {
    [[maybe_unused]] const int owner = ::fchown(fd, status.st_uid, status.st_gid);
    return ::fchmod(fd, status.st_mode & 07777) == 0 ? 0 : errno;
}

/// So that the new name outlives a power cut. The file itself is safe: no reason to fail.
void sync_folder(const fs::path& folder) {
    const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.get() >= 0) sync(opened.get());
}

}  // namespace

void write_file_atomically(const fs::path& path, std::span<const uint8_t> bytes) {
    const std::optional<struct stat> status = status_of(path);
    if (is_stream(path, status)) return write_stream(path, bytes);

    const fs::path target = follow_links(path);
    const fs::path folder = folder_of(target, path);
    TemporaryFile temporary(folder, path);
    const auto check = [&](int error) {
        if (error != 0) throw system_refusal(path, error);
    };
    check(write_all(temporary.file().get(), bytes));
    if (status) check(keep_rights(temporary.file().get(), *status));
    check(sync(temporary.file().get()));
    check(temporary.file().close());
    check(temporary.rename_to(target));
    sync_folder(folder);
}

void write_file_atomically(const fs::path& path, std::string_view text) {
    write_file_atomically(path,
                          std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

void check_writable(const fs::path& path) {
    if (is_stream(path, status_of(path))) return;
    const TemporaryFile trial(folder_of(follow_links(path), path), path);
}

}  // namespace petzval
