// SPDX-License-Identifier: Apache-2.0
#include "apps/request/quantity.h"

#include <fmt/format.h>

#include "io/base/ascii.h"

namespace petzval::apps {
namespace {

// "m (or mm, cm)", or nothing.
std::string names_of(std::span<const Unit> units) {
    if (units.empty()) return "";
    std::string others;
    for (const Unit& unit : units.subspan(1))
        others += fmt::format("{}{}", others.empty() ? "" : ", ", unit.name);
    return fmt::format(" {}{}", units[0].name, others.empty() ? "" : " (or " + others + ")");
}

std::string complaint(std::string_view text, const NumberRange& range) {
    return fmt::format("\"{}\" is not a number from {:g} to {:g}{}", text, range.least, range.most,
                       names_of(range.units));
}

// Digits of an f-number: f/2, F2, f:2, ƒ/2, and 1:2 as it is engraved on lenses.
std::string_view without_f(std::string_view text) {
    for (const std::string_view f : {"f", "F", "ƒ"}) {
        if (!text.starts_with(f)) continue;
        text.remove_prefix(f.size());
        if (text.starts_with('/') || text.starts_with(':')) text.remove_prefix(1);
        return text;
    }
    if (text.starts_with("1:")) text.remove_prefix(2);
    return text;
}

}  // namespace

std::optional<double> quantity(std::string_view text, std::span<const Unit> units) {
    text = io::trimmed(text);
    if (const auto plain = number<double>(text)) return plain;
    const std::string lowered = io::lower(std::string(text));
    for (const Unit& unit : units) {
        if (!lowered.ends_with(io::lower(std::string(unit.name)))) continue;
        const auto value =
            number<double>(io::trimmed(text.substr(0, text.size() - unit.name.size())));
        if (value) return *value * unit.times / unit.over;
    }
    return std::nullopt;
}

double parse_number(const std::string& option, const std::string& text, const NumberRange& range) {
    const auto value = quantity(text, range.units);
    if (!value || *value < range.least || *value > range.most)
        throw ValueError(option, complaint(text, range));
    return *value;
}

double parse_fnumber(const std::string& option, const std::string& text, const NumberRange& range) {
    const auto value = number<double>(without_f(io::trimmed(text)));
    if (!value || *value < range.least || *value > range.most)
        throw ValueError(option, complaint(text, range) + ", as 2 or f/2");
    return *value;
}

uint64_t parse_whole_number(const std::string& option, const std::string& text, uint64_t least,
                            uint64_t most) {
    const auto value = number<uint64_t>(text);
    if (!value || *value < least || *value > most)
        throw ValueError(
            option, fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most));
    return *value;
}

}  // namespace petzval::apps
