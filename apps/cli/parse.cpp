// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/parse.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <string_view>

namespace petzval {
namespace {

constexpr int kLargestSide_px = 65536;
constexpr float kNearestFocus_m = 1e-6f, kFarthestFocus_m = 1e9f;

[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& want) {
    throw CLI::ValidationError(option, fmt::format("\"{}\" is not {}", text, want));
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

template <class T>
std::optional<T> number(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty())
        return std::nullopt;
    if constexpr (std::is_floating_point_v<T>)
        if (!std::isfinite(value)) return std::nullopt;
    return value;
}

}  // namespace

std::vector<float> parse_numbers(const std::string& option, const std::string& text, size_t n) {
    std::vector<float> values;
    for (const std::string_view part : split(text, ','))
        if (const auto value = number<float>(part)) values.push_back(*value);
    if (values.size() != n || split(text, ',').size() != n)
        refuse(option, text, fmt::format("{} numbers with commas between them", n));
    return values;
}

V2i parse_size(const std::string& option, const std::string& text) {
    const auto parts = split(text, 'x');
    if (parts.size() == 2) {
        const auto w = number<int>(parts[0]), h = number<int>(parts[1]);
        const auto fits = [](int side) { return side >= 1 && side <= kLargestSide_px; };
        if (w && h && fits(*w) && fits(*h)) return {*w, *h};
    }
    refuse(option, text, fmt::format("WIDTHxHEIGHT in pixels, 1 to {} each", kLargestSide_px));
}

V2f parse_sensor(const std::string& option, const std::string& text, double least, double most) {
    const auto parts = split(text, 'x');
    if (parts.size() == 2) {
        const auto w = number<float>(parts[0]), h = number<float>(parts[1]);
        const auto fits = [&](float side) { return side >= least && side <= most; };
        if (w && h && fits(*w) && fits(*h)) return {*w, *h};
    }
    refuse(option, text, fmt::format("WIDTHxHEIGHT in millimetres, {:g} to {:g}", least, most));
}

Rect parse_crop(const std::string& option, const std::string& text, V2i frame) {
    const auto parts = split(text, ',');
    std::vector<int> v;
    for (const std::string_view part : parts)
        if (const auto value = number<int>(part)) v.push_back(*value);
    if (v.size() == 4 && parts.size() == 4) {
        const auto inside = [](int at, int size, int whole) {
            return at >= 0 && at < whole && size >= 1 && size <= whole - at;
        };
        if (inside(v[0], v[2], frame.x) && inside(v[1], v[3], frame.y))
            return {v[0], v[1], v[0] + v[2], v[1] + v[3]};
    }
    refuse(option, text, fmt::format("x,y,width,height inside the {}x{} frame", frame.x, frame.y));
}

V2i parse_pixel(const std::string& option, const std::string& text) {
    if (const auto parts = split(text, ','); parts.size() == 2) {
        const auto x = number<int>(parts[0]), y = number<int>(parts[1]);
        if (x && y) return {*x, *y};
    }
    refuse(option, text, "a pixel x,y");
}

double parse_duration_s(const std::string& option, const std::string& text) {
    double unit_s = 1;
    std::string_view digits = text;
    if (!digits.empty()) {
        const char last = digits.back();
        if (last == 's' || last == 'm' || last == 'h') {
            unit_s = last == 'h' ? 3600 : last == 'm' ? 60 : 1;
            digits.remove_suffix(1);
        }
    }
    const auto value = number<double>(digits);
    if (!value || *value <= 0) refuse(option, text, "a time such as 90s, 1.5m or 2h");
    return *value * unit_s;
}

uint64_t parse_memory_bytes(const std::string& option, const std::string& text) {
    constexpr std::array<std::pair<std::string_view, double>, 8> units{{{"kB", 1e3},
                                                                        {"MB", 1e6},
                                                                        {"GB", 1e9},
                                                                        {"TB", 1e12},
                                                                        {"KiB", 0x1p10},
                                                                        {"MiB", 0x1p20},
                                                                        {"GiB", 0x1p30},
                                                                        {"TiB", 0x1p40}}};
    for (const auto& [unit, bytes] : units) {
        if (!text.ends_with(unit)) continue;
        const auto count =
            number<double>(std::string_view(text).substr(0, text.size() - unit.size()));
        if (count && *count * bytes >= 1 && *count * bytes < 0x1p62)
            return static_cast<uint64_t>(*count * bytes);
    }
    refuse(option, text, "an amount of memory such as 512MB, 8GB or 8GiB");
}

double parse_share(const std::string& option, const std::string& text) {
    const bool per_cent = text.ends_with('%');
    const auto value = number<double>(std::string_view(text).substr(0, text.size() - per_cent));
    const double share = value.value_or(0) / (per_cent ? 100 : 1);
    if (!(share > 0 && share <= 1))
        refuse(option, text, "a share such as 1% or 0.01, 100% at most");
    return share;
}

float parse_shutter_s(const std::string& option, const std::string& text) {
    constexpr float shortest_s = 1e-9f, longest_s = 1e9f;
    const auto parts = split(text, '/');
    const auto above = number<float>(parts[0]);
    const auto below = parts.size() == 2 ? number<float>(parts[1]) : std::optional(1.f);
    if (parts.size() <= 2 && above && below)
        if (const float s = *above / *below; s >= shortest_s && s <= longest_s) return s;
    refuse(option, text, "seconds above 0, as 0.01 or 1/100");
}

namespace {

std::optional<float> focus_distance_m(std::string_view text) {
    if (text == "infinity") return std::numeric_limits<float>::infinity();
    if (!text.empty() && text.back() == 'm') text.remove_suffix(1);
    const auto value = number<float>(text);
    if (!value || *value < kNearestFocus_m || *value > kFarthestFocus_m) return std::nullopt;
    return value;
}

std::string focus_distances() {
    return fmt::format("a distance of {:g} to {:g} metres, infinity", kNearestFocus_m,
                       kFarthestFocus_m);
}

}  // namespace

float parse_focus_distance_m(const std::string& option, const std::string& text) {
    const auto distance_m = focus_distance_m(text);
    if (!distance_m) refuse(option, text, focus_distances());
    return *distance_m;
}

Focus parse_focus(const std::string& option, const std::string& text, V2i frame) {
    if (text == "auto") return FocusAuto{};
    if (const auto parts = split(text, ','); parts.size() == 2) {
        const auto x = number<int>(parts[0]), y = number<int>(parts[1]);
        if (x && y && *x >= 0 && *y >= 0 && *x < frame.x && *y < frame.y) return FocusPixel{*x, *y};
        refuse(option, text, fmt::format("a pixel x,y of the {}x{} frame", frame.x, frame.y));
    }
    const auto distance_m = focus_distance_m(text);
    if (!distance_m) refuse(option, text, focus_distances() + ", a pixel x,y or auto");
    return FocusDistance{*distance_m};
}

Bins parse_bins(const std::string& option, const std::string& text) {
    constexpr int most = 1024;  // more channels than readers of EXR expect
    // A wavelength is a float, which has steps of 0.00006 nm: narrower bins would show them.
    constexpr double narrowest_nm = 0.1;
    const auto parts = split(text, ':');
    std::vector<double> v;
    for (const std::string_view part : parts)
        if (const auto value = number<double>(part)) v.push_back(*value);
    if (v.size() != 3 || parts.size() != 3)
        refuse(option, text, "FIRST:LAST:WIDTH in nm, as 380:730:10");
    const double range_nm = v[1] - v[0];
    if (!(range_nm > 0)) refuse(option, text, "in rising order: FIRST must be below LAST");
    if (v[0] < kFirst_nm || v[1] > kLast_nm)
        refuse(option, text,
               fmt::format("inside {} to {} nm, all that paths carry", kFirst_nm, kLast_nm));
    const double count = range_nm / v[2];
    if (!(v[2] >= narrowest_nm) || !(count < most + 0.5))
        refuse(option, text, fmt::format("1 to {} bins of at least {} nm", most, narrowest_nm));
    if (std::fabs(count - std::round(count)) > 1e-6 || count < 0.5)
        refuse(option, text, "a whole number of bins from FIRST to LAST");
    return {v[0], v[2], static_cast<int>(std::lround(count))};
}

std::vector<Aov> parse_aovs(const std::string& option, const std::string& text) {
    std::vector<Aov> aovs;
    for (const std::string_view name : split(text, ',')) {
        const auto aov = aov_from_name(name);
        if (!aov) {
            std::string known;
            for (int i = 0; i < static_cast<int>(Aov::Count); ++i)
                known += fmt::format("{}{}", i ? ", " : "", aov_info(static_cast<Aov>(i)).name);
            refuse(option, std::string(name), "a layer; there are " + known);
        }
        if (std::find(aovs.begin(), aovs.end(), *aov) == aovs.end()) aovs.push_back(*aov);
    }
    return aovs;
}

Check number_between(double least, double most) {
    return [=](const std::string& text) -> std::string {
        const auto value = number<double>(text);
        if (value && *value >= least && *value <= most) return "";
        return fmt::format("\"{}\" is not a number from {:g} to {:g}", text, least, most);
    };
}

Check whole_number_between(uint64_t least, uint64_t most) {
    return [=](const std::string& text) -> std::string {
        const auto value = number<uint64_t>(text);
        if (value && *value >= least && *value <= most) return "";
        return fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most);
    };
}

}  // namespace petzval
