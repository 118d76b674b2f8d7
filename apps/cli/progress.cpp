// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <mutex>

namespace petzval {
namespace {

std::string clock_text(double seconds) {
    const long s = std::lround(seconds);
    return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                    : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string rate_text(double per_s) {
    return per_s < 1e6 ? fmt::format("{:.0f} k samples/s", per_s / 1e3)
                       : fmt::format("{:.2f} M samples/s", per_s / 1e6);
}

std::string bar(double fraction) {
    constexpr int width = 30;
    const int full = static_cast<int>(fraction * width);
    return std::string(static_cast<size_t>(full), '#') +
           std::string(static_cast<size_t>(width - full), '.');
}

}  // namespace

Progress::Progress(ProgressStyle style, const RenderMonitor& monitor, std::optional<uint64_t> total,
                   std::optional<double> time_limit_s)
    : style_(style),
      monitor_(monitor),
      total_(total),
      time_limit_s_(time_limit_s),
      start_(std::chrono::steady_clock::now()) {
    if (style_ == ProgressStyle::Auto)
        style_ = isatty(STDERR_FILENO) ? ProgressStyle::Bar : ProgressStyle::Lines;
    if (style_ == ProgressStyle::None) return;
    thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

Progress::~Progress() {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
    show(true);
}

void Progress::watch(const std::stop_token& stop) {
    using namespace std::chrono_literals;
    const auto every = style_ == ProgressStyle::Bar ? 200ms : 2000ms;
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, stop, every, [&] { return stop.stop_requested(); })) show(false);
}

void Progress::show(bool last) {
    const double elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const uint64_t done = monitor_.pixel_samples_done;
    const double rate = static_cast<double>(done) / std::max(elapsed_s, 1e-9);
    double fraction = 0;
    if (total_) fraction = static_cast<double>(done) / static_cast<double>(*total_);
    if (time_limit_s_ && !(last && total_ && done == *total_))
        fraction = std::max(fraction, elapsed_s / *time_limit_s_);
    fraction = std::clamp(fraction, 0.0, 1.0);
    const double left_s = fraction > 0 ? elapsed_s * (1 - fraction) / fraction : 0;

    std::string text;
    if (style_ == ProgressStyle::Json) {
        text = fmt::format(
            R"({{"fraction":{:.5f},"pixel_samples":{},"samples_per_s":{:.0f},"elapsed_s":{:.3f},"remaining_s":{:.3f}}})",
            fraction, done, rate, elapsed_s, left_s);
        text += '\n';
    } else {
        const std::string figures =
            fmt::format("{:5.1f} %  {}  {} elapsed, {} left", 100 * fraction, rate_text(rate),
                        clock_text(elapsed_s), clock_text(left_s));
        if (style_ == ProgressStyle::Bar)
            text = fmt::format("\r[{}] {}\033[K{}", bar(fraction), figures, last ? "\n" : "");
        else
            text = figures + '\n';
    }
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace petzval
