// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "io/base/printable.h"

namespace petzval {

void print_error_line(std::string line) noexcept {
    try {
        line = visible(line);
    } catch (const std::exception&) {  // no memory: nothing but plain characters, in place
        for (char& c : line)
            if (c < 0x20 || c == 0x7F) c = '?';
    }
    std::fputs(line.c_str(), stderr);
    std::fputc('\n', stderr);
    std::fflush(stderr);
}

void print_line(const std::string& line) {
    fmt::print("{}\n", visible(line));
}

void print_notice(NoticeStyle style, const std::string& text) {
    using nlohmann::json;
    if (style == NoticeStyle::Text) print_error_line("petzval: " + text);
    if (style == NoticeStyle::Json)  // names of files need not be UTF-8
        print_error_line(
            json{{"notice", text}}.dump(-1, ' ', true, json::error_handler_t::replace));
}

}  // namespace petzval
