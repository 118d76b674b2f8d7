// SPDX-License-Identifier: Apache-2.0
// Text files of lines and words, as programs of lens design write them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::io {

struct TextLine {
    int number;        ///< from 1
    std::string text;  ///< without its end

    /// "line N", for InputError's place.
    [[nodiscard]] std::string place() const { return "line " + std::to_string(number); }
};

/// Text of a whole file, at most 16 MiB. Throws InputError where it cannot be read.
[[nodiscard]] std::string text_of_file(const std::filesystem::path&);

/// The lines of a text: LF or CR LF; UTF-16 with a byte order mark becomes UTF-8, and what is not
/// UTF-16 stays as it is, less its byte order mark. file: its name. Throws InputError with the line
/// where there is a zero byte: that is no text.
[[nodiscard]] std::vector<TextLine> text_lines(std::string_view text, const std::string& file);

/// Text up to its first line break.
[[nodiscard]] inline std::string first_line(const std::string& text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

/// Text without the spaces, tabs and line breaks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view);
/// Parts of a text between the places of a character.
[[nodiscard]] std::vector<std::string_view> split(std::string_view, char at);

/// Words of a line, separated by spaces and tabs.
[[nodiscard]] std::vector<std::string> words(std::string_view line);

/// A finite number and nothing else, whatever the locale; a leading + is allowed.
[[nodiscard]] std::optional<double> finite_number(std::string_view);

}  // namespace petzval::io
