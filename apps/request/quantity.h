// SPDX-License-Identifier: Apache-2.0
// Numbers with units, as every option of every command takes them.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "apps/request/value_error.h"
#include "io/file/text_lines.h"

namespace petzval::apps {

/// Unit of a kind: a number in it counts `times` / `over` of the kind's first unit. As a ratio,
/// since 35 / 1000 is the double nearest to 0.035, and 35 * 0.001 is not.
struct Unit {
    std::string_view name;
    double times = 1, over = 1;
};

/// Lengths. The inch is 25.4 mm and the foot 12 inches: the international yard and pound agreement
/// of 1959.
inline constexpr std::array<Unit, 6> kMetres{{{"m", 1, 1},
                                              {"mm", 1, 1000},
                                              {"cm", 1, 100},
                                              {"km", 1000, 1},
                                              {"in", 254, 10000},
                                              {"ft", 3048, 10000}}};
inline constexpr std::array<Unit, 5> kMillimetres{
    {{"mm", 1, 1}, {"cm", 10, 1}, {"m", 1000, 1}, {"in", 254, 10}, {"ft", 3048, 10}}};
inline constexpr std::array<Unit, 4> kDegrees{{{"deg"}, {"°"}, {"degrees"}, {"degree"}}};
inline constexpr std::array<Unit, 1> kPixels{{{"px"}}};
inline constexpr std::array<Unit, 1> kNanometres{{{"nm"}}};
inline constexpr std::array<Unit, 1> kStops{{{"EV"}}};

/// Decimal number that is the whole of a text; nothing where that is anything else or not finite.
template <class T>
[[nodiscard]] std::optional<T> number(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty())
        return std::nullopt;
    if constexpr (std::is_floating_point_v<T>)
        if (!std::isfinite(value)) return std::nullopt;
    return value;
}

/// Number with or without one of these units, in the first of them: 0.3 for "30cm" in kMetres.
[[nodiscard]] std::optional<double> quantity(std::string_view text, std::span<const Unit>);

/// Interval of numbers that a value may take, ends included, and its units.
struct NumberRange {
    double least, most;
    std::span<const Unit> units = {};
};

/// Number in a range, in the first of its units. Throws ValueError, which names the option.
[[nodiscard]] double parse_number(const std::string& option, const std::string& text,
                                  const NumberRange&);
/// The same for an f-number, which may read f/2, F2 or 1:2.
[[nodiscard]] double parse_fnumber(const std::string& option, const std::string& text,
                                   const NumberRange&);
/// The same for a whole number, always decimal: "010" is ten.
[[nodiscard]] uint64_t parse_whole_number(const std::string& option, const std::string& text,
                                          uint64_t least, uint64_t most);

}  // namespace petzval::apps
