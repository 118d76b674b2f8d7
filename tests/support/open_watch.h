// SPDX-License-Identifier: Apache-2.0
// Waits until some process opens a file.
#pragma once

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace petzval::test {

/// Sees what opens the file from when it was made on.
class OpenWatch {
  public:
    explicit OpenWatch(const std::string& file) {
        if (notices_ < 0 || inotify_add_watch(notices_, file.c_str(), IN_OPEN) < 0)
            throw std::runtime_error("nothing to watch " + file + " with");
    }
    OpenWatch(const OpenWatch&) = delete;
    OpenWatch& operator=(const OpenWatch&) = delete;
    ~OpenWatch() { close(notices_); }

    /// False where nobody has opened it after two minutes.
    [[nodiscard]] bool wait() const { return is_told_within(120'000); }
    /// Whether somebody has opened it by now.
    [[nodiscard]] bool has_happened() const { return is_told_within(0); }

  private:
    [[nodiscard]] bool is_told_within(int ms) const {
        pollfd wanted{notices_, POLLIN, 0};
        return poll(&wanted, 1, ms) == 1;
    }

    int notices_ = inotify_init1(IN_CLOEXEC);
};

}  // namespace petzval::test
