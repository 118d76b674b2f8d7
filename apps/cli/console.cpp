// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <exception>

#include "apps/request/option_text.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/file/atomic_file.h"

namespace petzval::apps {
namespace {

constexpr std::string_view kWarning = "warning: ";

/// Writes all of a line; where that fails there is nobody to tell.
void write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(descriptor, text.data(), text.size());
        if (n < 0 && errno != EINTR) return;
        if (n > 0) text.remove_prefix(static_cast<size_t>(n));
    }
}

/// Whether a line begins with a time, as "2026-11-24T13:25:35Z ".
bool is_log_line(const std::string& line) {
    constexpr std::string_view kPattern = "0000-00-00T00:00:00Z ";
    if (line.size() < kPattern.size()) return false;
    for (size_t i = 0; i < kPattern.size(); ++i)
        if (kPattern[i] == '0' ? line[i] < '0' || line[i] > '9' : line[i] != kPattern[i])
            return false;
    return true;
}

}  // namespace

ConsoleWish console_wish(const std::vector<std::string>& words) {
    ConsoleWish wish;
    wish.quiet = std::find(words.begin(), words.end(), "--quiet") != words.end();
    if (words.empty() || (words.front() != "render" && words.front() != "resume")) return wish;
    const auto take = [&](std::string_view value) {
        wish.asks_progress = true;
        wish.style =
            io::lower(std::string(value)) == "json" ? ConsoleStyle::Json : ConsoleStyle::Text;
    };
    constexpr std::string_view kOption = "--progress", kWithValue = "--progress=";
    for (size_t i = 0; i < words.size(); ++i) {
        if (words[i].starts_with(kWithValue)) take(words[i].substr(kWithValue.size()));
        if (words[i] == kOption && i + 1 < words.size()) take(words[i + 1]);
    }
    return wish;
}

void print_error_line(std::string line) noexcept {
    try {
        line = io::visible(as_options(line));
    } catch (const std::exception&) {  // no memory: nothing but plain characters, in place
        for (char& c : line)
            if (c < 0x20 || c == 0x7F) c = '?';
    }
    std::fputs(line.c_str(), stderr);
    std::fputc('\n', stderr);
    std::fflush(stderr);
}

void print_line(const std::string& line) {
    fmt::print("{}\n", io::visible(as_options(line)));
}

void print_notice(const std::string& text) {
    print_error_line("petzval: " + text);
}

Console::Console(ConsoleStyle style, bool quiet) : style_(style), quiet_(quiet) {
    if (style_ != ConsoleStyle::Json) return;
    const std::lock_guard lock(mutex_);
    capture_.emplace([this](std::string printed) {
        const std::lock_guard one(mutex_);
        if (!quiet_) put_event("library", {{"text", std::move(printed)}});
    });
    if (capture_->before() >= 0) to_ = capture_->before();
}

void Console::notice(const std::string& message) {
    const std::string text = as_options(message);
    const std::lock_guard lock(mutex_);
    const bool warning = text.starts_with(kWarning);
    if (warning)
        messages_.warnings.push_back(text.substr(kWarning.size()));
    else
        messages_.notices.push_back(text);
    log(text);
    if (quiet_) return;
    if (style_ == ConsoleStyle::Json)
        put_event(warning ? "warning" : "notice", {{"notice", text}});
    else
        put("petzval: " + text);
}

void Console::error(const std::string& message) {
    const std::string text = as_options(message);
    const std::lock_guard lock(mutex_);
    messages_.errors.push_back(text);
    log("error: " + text);
    if (style_ == ConsoleStyle::Json)
        put_event("error", {{"error", text}});
    else
        put("petzval: error: " + text);
}

void Console::line(const std::string& text) {
    const std::lock_guard lock(mutex_);
    log(text);
    put(text);
}

void Console::live_line(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (text.empty()) return clear_live_line();
    std::fputs(("\r" + text + "\033[K").c_str(), stderr);
    live_ = true;
}

void Console::event(const char* name, const Json& fields) {
    const std::lock_guard lock(mutex_);
    put_event(name, fields);
}

void Console::log_to(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
        throw io::OutputError(file.string(), "", "is no file; a log needs one");
    io::check_writable(file);
    std::ifstream before(file);
    if (std::string line; std::getline(before, line) && !is_log_line(line))
        throw io::ArgumentError(
            file.string(), "",
            "is no log of this program's, and messages would be added to it; name "
            "another file");
    const std::lock_guard lock(mutex_);
    log_.open(file, std::ios::app);
    if (!log_) throw io::OutputError(file.string(), "", "cannot be written");
}

void Console::end(int exit_code) {
    {
        const std::lock_guard lock(mutex_);
        log(fmt::format("ends with exit code {}", exit_code));
    }
    if (style_ != ConsoleStyle::Json) return;
    capture_.reset();  // what libraries printed comes before the end
    to_ = STDERR_FILENO;
    if (!quiet_) event("end", {{"exit_code", exit_code}});
}

Messages Console::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

void Console::log(const std::string& text) {
    if (!log_.is_open()) return;
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> time{};
    std::strftime(time.data(), time.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    log_ << time.data() << ' ' << io::visible(text)
         << std::endl;  // flushed: the next may be the last
    if (log_) return;
    log_.close();
    print_error_line("petzval: warning: the log cannot be written any more");
}

void Console::forget_messages() {
    const std::lock_guard lock(mutex_);
    messages_ = {};
}

void Console::put(const std::string& text) {
    clear_live_line();
    print_error_line(text);
}

void Console::put_event(const char* name, const Json& fields) {
    Json all{{"schema", "petzval.progress"}, {"version", 1}, {"event", name}};
    all.update(fields);
    // Names of files need not be UTF-8.
    const std::string line = all.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
    write_all(to_, line);
}

void Console::clear_live_line() {
    if (live_) std::fputs("\r\033[K", stderr);
    live_ = false;
}

}  // namespace petzval::apps
