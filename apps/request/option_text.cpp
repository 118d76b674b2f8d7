// SPDX-License-Identifier: Apache-2.0
#include "apps/request/option_text.h"

#include <algorithm>
#include <string_view>

#include "apps/request/fields.h"

namespace petzval::apps {
namespace {

bool is_method(const std::string& name) {
    const auto field = find_field(name);
    return field && field->level == FieldLevel::Method;
}

// Options that are of no request, as those of petzval chart, are spelled alike.
std::string option_of(const std::string& name) {
    const auto field = find_field(name);
    if (field && !field->short_name.empty()) return "-" + field->short_name;
    return (field && field->level == FieldLevel::Method ? "--method " : "--") + name;
}

}  // namespace

std::string with_names(const std::string& message, const NameSpelling& spelling) {
    constexpr std::string_view kOpen = "⟨", kClose = "⟩";
    std::string text;
    size_t done = 0;
    for (;;) {
        const size_t open = message.find(kOpen, done), name_at = open + kOpen.size();
        const size_t close = open == message.npos ? open : message.find(kClose, name_at);
        if (close == message.npos) return text + message.substr(done);
        const std::string name = message.substr(name_at, close - name_at);
        const bool is_name = !name.empty() && std::ranges::all_of(name, [](char c) {
            return (c >= 'a' && c <= 'z') || c == '-';
        });
        text += message.substr(done, open - done);
        done = is_name ? close + kClose.size() : name_at;
        if (!is_name) {
            text += kOpen;
            continue;
        }
        const bool has_value = done < message.size() && message[done] == '=';
        text += spelling(name, has_value);
        done += has_value;
    }
}

std::string as_options(const std::string& message) {
    return with_names(message, [](const std::string& name, bool has_value) {
        return option_of(name) + (!has_value ? "" : is_method(name) ? "=" : " ");
    });
}

}  // namespace petzval::apps
