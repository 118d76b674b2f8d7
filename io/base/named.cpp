// SPDX-License-Identifier: Apache-2.0
#include "io/base/named.h"

#include <fmt/format.h>

#include <charconv>

#include "io/base/nearest.h"
#include "io/base/printable.h"

namespace petzval::io {

std::optional<size_t> find_named(const std::string& wanted, const std::vector<std::string>& names) {
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == wanted || visible(names[i]) == wanted) return i;
    size_t index = 0;
    const char* const last = wanted.data() + wanted.size();
    const auto [end, error] = std::from_chars(wanted.data(), last, index);
    if (error == std::errc() && end == last && index < names.size()) return index;
    return std::nullopt;
}

std::string numbered(const std::vector<std::string>& names) {
    constexpr size_t kMost = 20;  // fit one message
    std::string text;
    for (size_t i = 0; i < names.size() && i < kMost; ++i)
        text += fmt::format("{}{} \"{}\"", i ? ", " : "", i, printable(names[i]));
    if (names.size() > kMost) text += fmt::format(" and {} more", names.size() - kMost);
    return text;
}

std::string no_such(const std::string& kind, const std::string& wanted,
                    const std::vector<std::string>& names, const std::string& otherwise) {
    std::vector<std::string> shown;
    shown.reserve(names.size());
    for (const std::string& name : names) shown.push_back(printable(name));
    return fmt::format("no {} \"{}\"; {}{}", kind, wanted,
                       names.empty() ? otherwise : "it has " + numbered(names),
                       did_you_mean(wanted, shown));
}

}  // namespace petzval::io
