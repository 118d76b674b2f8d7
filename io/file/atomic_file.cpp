// SPDX-License-Identifier: Apache-2.0
#include "io/file/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <thread>
#include <utility>

#include "io/base/error.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

OutputError refusal(const fs::path& path, const std::string& why) {
    return {path.string(), "", "cannot be written: " + why};
}
OutputError system_refusal(const fs::path& path, int error) {
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
    /// Closes the file, the last chance of some file systems to report an error. Error number, 0
    /// for none.
    [[nodiscard]] int close() { return ::close(std::exchange(fd_, -1)) == 0 ? 0 : errno; }

  private:
    int fd_;
};

/// Writes all bytes from an offset on. Error number, 0 for none.
int write_at(int fd, std::span<const uint8_t> bytes, uint64_t offset) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno != EINTR) return errno;
        if (written <= 0) continue;
        offset += static_cast<uint64_t>(written);
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
    return 0;
}

/// Copies a whole file to a stream. Error number, 0 for none.
int copy_all(int from, int to) {
    std::array<uint8_t, 65536> bytes;
    for (off_t offset = 0;;) {
        const ssize_t there = ::pread(from, bytes.data(), bytes.size(), offset);
        if (there == 0) return 0;
        if (there < 0 && errno != EINTR) return errno;
        for (ssize_t done = 0; done < there;) {
            const ssize_t written =
                ::write(to, bytes.data() + done, static_cast<size_t>(there - done));
            if (written < 0 && errno != EINTR) return errno;
            if (written > 0) done += written;
        }
        if (there > 0) offset += there;
    }
}

/// Syncs a file. Error number, 0 for none; a file system that cannot sync is no error.
int sync(int fd) {
    if (::fsync(fd) == 0 || errno == EINVAL || errno == ENOTSUP) return 0;
    return errno;
}

std::string random_name() {
    std::random_device random;
    return fmt::format(".petzval-{:08x}{:08x}", random(), random());
}

/// A file of its own beside the target: without a name where the file system has such files, else
/// with one, and deleted when it goes unless it was renamed.
class TemporaryFile {
  public:
    TemporaryFile(const fs::path& folder, const fs::path& for_message);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }
    [[nodiscard]] Descriptor& file() { return *file_; }
    /// Gives the file a name in its folder. Error number, 0 for none.
    [[nodiscard]] int name_it() {
        if (!path_.empty()) return 0;
        const std::string unnamed = fmt::format("/proc/self/fd/{}", file_->get());
        const fs::path path = folder_ / random_name();
        if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) != 0)
            return errno;
        path_ = path;
        return 0;
    }
    /// Moves the file to its target. Error number, 0 for none.
    [[nodiscard]] int rename_to(const fs::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
        path_.clear();
        return 0;
    }

  private:
    fs::path folder_, path_;
    std::optional<Descriptor> file_;
};

TemporaryFile::TemporaryFile(const fs::path& folder, const fs::path& for_message)
    : folder_(folder) {
    // Without /proc an unnamed file could not get a name.
    if (::access("/proc/self/fd", X_OK) == 0) {
        const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
        if (fd >= 0) {
            file_.emplace(fd);
            return;
        }
    }
    for (;;) {
        const fs::path path = folder / random_name();
        const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
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

/// Temporary file for the output of a stream, open for reading too.
Descriptor spool(const fs::path& for_message) {
    std::FILE* file = std::tmpfile();
    if (!file) throw system_refusal(for_message, errno);
    Descriptor descriptor(::fcntl(::fileno(file), F_DUPFD_CLOEXEC, 0));
    std::fclose(file);
    if (descriptor.get() < 0) throw system_refusal(for_message, errno);
    return descriptor;
}

/// Target of a path through any number of links up to Linux's own limit; it may not exist.
fs::path follow_links(fs::path path) {
    constexpr int kMaxLinks = 40;
    std::error_code error;
    for (int i = 0; i < kMaxLinks; ++i) {
        if (!fs::is_symlink(path, error)) return path;
        path = path.parent_path() / fs::read_symlink(path, error);
    }
    throw system_refusal(path, ELOOP);
}

/// Whether a path is a stream, with nothing to rename over: pipes, terminals and devices, and
/// standard output whatever it is.
bool is_stream(const fs::path& path, const std::optional<struct stat>& status) {
    if (status && !S_ISREG(status->st_mode)) return true;
    const std::string name = path.string();
    return name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/") ||
           name.starts_with("/proc/");
}

/// Status of a file; nothing where there is none yet. Throws where there can be none.
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

// Waits for the reader of a pipe, but not for ever: one that has gone would hold the program after
// hours of work.
Descriptor open_stream(const fs::path& path) {
    constexpr int flags = O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC;
    constexpr std::chrono::milliseconds pause(50), patience(3000);
    for (auto waited = std::chrono::milliseconds(0);; waited += pause) {
        Descriptor file(::open(path.c_str(), flags | O_NONBLOCK));
        if (file.get() >= 0) {
            if (::fcntl(file.get(), F_SETFL, flags) != 0) throw system_refusal(path, errno);
            return file;
        }
        if (errno != ENXIO) throw system_refusal(path, errno);
        if (waited >= patience) throw refusal(path, "nobody reads this pipe");
        std::this_thread::sleep_for(pause);
    }
}

/// Takes over owner (where that is allowed) and permissions of the file that is replaced. Error
/// number, 0 for none.
int keep_rights(int fd, const struct stat& status) {
    [[maybe_unused]] const int owner = ::fchown(fd, status.st_uid, status.st_gid);
    return ::fchmod(fd, status.st_mode & 07777) == 0 ? 0 : errno;
}

/// Syncs a folder, so that a new name in it outlives a power cut. The file itself is safe: no
/// reason to fail.
void sync_folder(const fs::path& folder) {
    const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.get() >= 0) sync(opened.get());
}

}  // namespace

struct AtomicFile::State {
    explicit State(const fs::path& target) : path(target), status(status_of(target)) {
        if (is_stream(path, status)) {
            spooled.emplace(spool(path));
            return;
        }
        real_path = follow_links(path);
        beside.emplace(folder_of(real_path, path), path);
    }
    void check(int error_number) const {
        if (error_number != 0) throw system_refusal(path, error_number);
    }
    Descriptor& file() { return spooled ? *spooled : beside->file(); }
    void rename();
    void send();

    fs::path path;
    std::optional<struct stat> status;
    fs::path real_path;
    std::optional<Descriptor> spooled;    ///< for a stream,
    std::optional<TemporaryFile> beside;  ///< or for a file
    int error = 0;
};

void AtomicFile::State::rename() {
    if (status) check(keep_rights(file().get(), *status));
    check(sync(file().get()));
    check(beside->name_it());
    check(file().close());
    check(beside->rename_to(real_path));
    sync_folder(folder_of(real_path, path));
}

void AtomicFile::State::send() {
    Descriptor stream = open_stream(path);
    check(copy_all(file().get(), stream.get()));
    check(stream.close());
}

AtomicFile::AtomicFile(const fs::path& target) : state_(std::make_unique<State>(target)) {}
AtomicFile::~AtomicFile() = default;

void AtomicFile::write(std::span<const uint8_t> bytes, uint64_t offset) noexcept {
    if (state_->error == 0) state_->error = write_at(state_->file().get(), bytes, offset);
}

size_t AtomicFile::read(std::span<uint8_t> to, uint64_t offset) noexcept {
    size_t done = 0;
    while (state_->error == 0 && done < to.size()) {
        const ssize_t count = ::pread(state_->file().get(), to.data() + done, to.size() - done,
                                      static_cast<off_t>(offset + done));
        if (count < 0 && errno != EINTR) state_->error = errno;
        if (count == 0) break;
        done += count > 0 ? static_cast<size_t>(count) : 0;
    }
    return done;
}

void AtomicFile::commit() {
    state_->check(state_->error);
    if (state_->spooled)
        state_->send();
    else
        state_->rename();
}

void write_file_atomically(const fs::path& path, std::span<const uint8_t> bytes) {
    AtomicFile file(path);
    file.write(bytes, 0);
    file.commit();
}

void write_file_atomically(const fs::path& path, std::string_view text) {
    write_file_atomically(path,
                          std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

bool is_stream(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return is_stream(path, std::nullopt);
    return !S_ISDIR(status.st_mode) && is_stream(path, status);
}

void check_writable(const fs::path& path) {
    const auto status = status_of(path);
    if (is_stream(path, status)) {
        if (!status) throw system_refusal(path, ENOENT);  // nothing makes a stream
        return;
    }
    const TemporaryFile trial(folder_of(follow_links(path), path), path);
}

}  // namespace petzval::io
