// SPDX-License-Identifier: Apache-2.0
// Lines on stdout and stderr, for a person or a program that watches them. Names of files, and
// names in files, may hold anything: no character of a line is hidden, and none acts on a terminal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/stderr_capture.h"

namespace petzval::apps {

/// Prints one line on stderr, every character visible() (io/base/printable.h). Never throws: where
/// stderr cannot be written there is nobody to tell.
void print_error_line(std::string line) noexcept;

/// Prints one line on stdout, every character visible().
void print_line(const std::string& line);

/// Prints a notice: "petzval: TEXT".
void print_notice(const std::string& text);

/// Messages of a command.
struct Messages {
    std::vector<std::string> notices, warnings, errors;  ///< warnings without "warning: "
};

enum class ConsoleStyle : uint8_t { Text, Json };

/// How a command is asked to talk.
struct ConsoleWish {
    ConsoleStyle style = ConsoleStyle::Text;
    bool quiet = false;          ///< errors only
    bool asks_progress = false;  ///< in any style
};

/// Wish in the words of a command line; known before they are parsed, for their errors.
[[nodiscard]] ConsoleWish console_wish(const std::vector<std::string>& words);

/// Stderr of a command, as text or as one JSON object for each line; docs/guide/render.md has the
/// schema. Any thread may use it. As JSON it takes in what libraries print, so that nothing else
/// reaches stderr.
class Console {
  public:
    using Json = nlohmann::ordered_json;

    /// quiet: print nothing but errors.
    Console(ConsoleStyle, bool quiet);
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    [[nodiscard]] ConsoleStyle style() const { return style_; }
    /// Says what was chosen, or, after "warning: ", what is odd.
    void notice(const std::string& text);
    void error(const std::string& text);
    /// Prints a line as it is, as text.
    void line(const std::string& text);
    /// Shows a line that the next one replaces; an empty text clears it.
    void live_line(const std::string& text);
    /// Prints an event, as JSON.
    void event(const char* name, const Json& fields);
    /// From now on adds what is said to a file, with the time (UTC) of each line. Throws
    /// OutputError where it cannot be written, and ArgumentError where it holds anything but a log.
    void log_to(const std::filesystem::path&);
    /// Prints the last event.
    void end(int exit_code);
    /// Messages since the beginning, or since they were forgotten.
    [[nodiscard]] Messages messages() const;
    void forget_messages();

  private:
    void put(const std::string& line);
    void log(const std::string& text);
    void put_event(const char* name, const Json& fields);
    void clear_live_line();

    ConsoleStyle style_;
    bool quiet_, live_ = false;
    int to_ = 2;  ///< descriptor that JSON goes to
    mutable std::mutex mutex_;
    Messages messages_;
    std::ofstream log_;
    std::optional<StderrCapture> capture_;  // last: its thread uses the rest
};

}  // namespace petzval::apps
