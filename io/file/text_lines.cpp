// SPDX-License-Identifier: Apache-2.0
#include "io/file/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/base/error.h"
#include "io/file/read_file.h"

namespace petzval::io {
namespace {

constexpr uintmax_t kMaxBytes = 16 << 20;

// Appends a UTF-16 unit. Halves of surrogate pairs become '?': no name that matters has any.
void append_utf8(std::string& out, unsigned unit) {
    if (unit >= 0xD800 && unit < 0xE000) unit = '?';
    if (unit < 0x80) {
        out += static_cast<char>(unit);
    } else if (unit < 0x800) {
        out += static_cast<char>(0xC0 | unit >> 6);
        out += static_cast<char>(0x80 | (unit & 0x3F));
    } else {
        out += static_cast<char>(0xE0 | unit >> 12);
        out += static_cast<char>(0x80 | (unit >> 6 & 0x3F));
        out += static_cast<char>(0x80 | (unit & 0x3F));
    }
}

std::string as_utf8(std::string_view text) {
    const bool little = text.starts_with("\xFF\xFE"), big = text.starts_with("\xFE\xFF");
    if (!little && !big) return std::string(text.substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0));
    std::string out;
    for (size_t i = 2; i + 1 < text.size(); i += 2) {
        const auto first = static_cast<unsigned char>(text[i]);
        const auto second = static_cast<unsigned char>(text[i + 1]);
        append_utf8(out, little ? first | second << 8 : second | first << 8);
    }
    return out;
}

}  // namespace

std::string text_of_file(const std::filesystem::path& path) {
    std::error_code none;
    if (const uintmax_t size = std::filesystem::file_size(path, none); !none && size > kMaxBytes)
        throw InputError(path.string(), "", "has {} bytes, and such a file may have {}", size,
                         kMaxBytes);
    const FileBytes file = read_file(path);
    if (!file.error.empty()) throw InputError(path.string(), "", file.error);
    return {file.bytes.begin(), file.bytes.end()};
}

std::vector<TextLine> text_lines(std::string_view text, const std::string& file) {
    const std::string utf8 = as_utf8(text);
    std::vector<TextLine> lines;
    for (size_t begin = 0; begin < utf8.size();) {
        const size_t end = std::min(utf8.find('\n', begin), utf8.size());
        TextLine line{static_cast<int>(lines.size()) + 1, utf8.substr(begin, end - begin)};
        begin = end + 1;
        if (line.text.ends_with('\r')) line.text.pop_back();
        if (line.text.find('\0') != line.text.npos)
            throw InputError(file, line.place(),
                             "is not text; save the file as UTF-8, or as UTF-16 with its mark");
        lines.push_back(std::move(line));
    }
    return lines;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kSpaces = " \t\r\n";
    const size_t first = text.find_first_not_of(kSpaces);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (;;) {
        const size_t end = text.find(at);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

std::vector<std::string> words(std::string_view line) {
    constexpr std::string_view kSpaces = " \t";
    std::vector<std::string> out;
    for (size_t end, begin = 0; (begin = line.find_first_not_of(kSpaces, begin)) != line.npos;
         begin = end) {
        end = std::min(line.find_first_of(kSpaces, begin), line.size());
        out.emplace_back(line.substr(begin, end - begin));
    }
    return out;
}

// Not strtod: that depends on the locale.
std::optional<double> finite_number(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

}  // namespace petzval::io
