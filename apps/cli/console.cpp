// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace petzval {

void print_error_line(std::string line) noexcept {
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    std::fputs(line.c_str(), stderr);
    std::fputc('\n', stderr);
    std::fflush(stderr);
}

void print_notice(NoticeStyle style, const std::string& text) {
    using nlohmann::json;
    if (style == NoticeStyle::Text) print_error_line("petzval: " + text);
    if (style == NoticeStyle::Json)  // names of files need not be UTF-8
        print_error_line(
            json{{"notice", text}}.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace petzval
