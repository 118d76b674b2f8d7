// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/stderr_capture.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

namespace petzval::apps {

StderrCapture::StderrCapture(std::function<void(std::string)> line)
    : line_(std::move(line)), before_(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3)) {
    std::array<int, 2> ends{};
    if (before_ < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) return;
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[1]);
    from_ = ends[0];
    thread_ = std::thread([this] { read_lines(); });
}

StderrCapture::~StderrCapture() {
    if (thread_.joinable()) {
        std::fflush(stderr);
        ::dup2(before_, STDERR_FILENO);  // closes the pipe's end, so that the thread comes to its
        thread_.join();
        ::close(from_);
    }
    if (before_ >= 0) ::close(before_);
}

void StderrCapture::read_lines() const {
    std::string text;
    const auto pass_on = [&](size_t end) {
        if (end > 0) line_(text.substr(0, end));
        text.erase(0, end + 1);
    };
    std::array<char, 4096> bytes;
    for (;;) {
        const ssize_t n = ::read(from_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        text.append(bytes.data(), static_cast<size_t>(n));
        for (size_t end; (end = text.find('\n')) != text.npos;) pass_on(end);
    }
    if (!text.empty()) pass_on(text.size());
}

}  // namespace petzval::apps
