// SPDX-License-Identifier: Apache-2.0
#include "apps/request/parse.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "io/base/ascii.h"
#include "io/base/nearest.h"

namespace petzval::apps {
namespace {

constexpr int kLargestSide_px = 65536;
constexpr float kMostExposure_ev = 100;
constexpr float kNearestFocus_m = 1e-6f;
constexpr const char* kShutterTimes =
    "seconds above 0, as 0.01, 1/100 or 10ms, or an angle such as 180deg";

[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& want) {
    throw ValueError(option, fmt::format("\"{}\" is not {}", text, want));
}

bool is_shutter_time(float s) {
    return s >= 1e-9f && s <= 1e9f;
}

std::string text_of(const Rect& crop) {
    return fmt::format("{},{},{},{}", crop.x0, crop.y0, crop.width(), crop.height());
}

// Two sides from "WIDTHxHEIGHT", whatever stands for times.
std::vector<std::string> sides(std::string text) {
    constexpr std::string_view times = "×";
    if (const size_t at = text.find(times); at != std::string::npos)
        text.replace(at, times.size(), "x");
    text = io::lower(std::move(text));
    std::vector<std::string> out;
    for (const std::string_view side : io::split(text, 'x')) out.emplace_back(io::trimmed(side));
    return out;
}

std::vector<float> parse_all(const std::string& option, const std::string& text, size_t n,
                             std::span<const Unit> units, const char* what) {
    std::vector<float> values;
    for (const std::string_view part : io::split(text, ','))
        if (const auto value = quantity(part, units); value && std::isfinite(float(*value)))
            values.push_back(static_cast<float>(*value));
    if (values.size() != n || io::split(text, ',').size() != n)
        refuse(option, text, fmt::format("{} {} with commas between them", n, what));
    return values;
}

// Keeps what is computed from a place inside the numbers of a camera.
void require_near(const std::string& option, float m) {
    constexpr float kFarthest_m = 1e12f;
    if (std::fabs(m) > kFarthest_m)
        throw ValueError(option, fmt::format("{:g} m is too far away", m));
}

}  // namespace

std::vector<float> parse_numbers(const std::string& option, const std::string& text, size_t n) {
    return parse_all(option, text, n, {}, "numbers");
}

std::vector<float> parse_lengths_m(const std::string& option, const std::string& text, size_t n) {
    return parse_all(option, text, n, kMetres, "lengths");
}

V2i parse_size(const std::string& option, const std::string& text) {
    if (const auto parts = sides(text); parts.size() == 2) {
        const auto w = number<int>(parts[0]), h = number<int>(parts[1]);
        const auto fits = [](int side) { return side >= 1 && side <= kLargestSide_px; };
        if (w && h && fits(*w) && fits(*h)) return {*w, *h};
    }
    refuse(option, text, fmt::format("WIDTHxHEIGHT in pixels, 1 to {} each", kLargestSide_px));
}

V2f parse_sensor(const std::string& option, const std::string& text, double least, double most) {
    if (const auto parts = sides(text); parts.size() == 2) {
        const auto w = quantity(parts[0], kMillimetres), h = quantity(parts[1], kMillimetres);
        const auto fits = [&](double side) { return side >= least && side <= most; };
        if (w && h && fits(*w) && fits(*h)) return {static_cast<float>(*w), static_cast<float>(*h)};
    }
    refuse(option, text, fmt::format("WIDTHxHEIGHT in millimetres, {:g} to {:g}", least, most));
}

Crop parse_crop(const std::string& option, const std::string& text) {
    if (const auto parts = io::split(text, '/'); parts.size() == 2) {
        const auto part = number<int>(io::trimmed(parts[0])),
                   of = number<int>(io::trimmed(parts[1]));
        if (part && of && 1 <= *part && *part <= *of) return FrameBand{*part, *of};
        refuse(option, text, "I/N, the I-th of N bands of the frame, with I from 1 to N");
    }
    const auto parts = io::split(text, ',');
    std::vector<int> v;
    for (const std::string_view part : parts)
        if (const auto value = number<int>(io::trimmed(part))) v.push_back(*value);
    const auto fits = [](int at, int size) {
        return at >= 0 && size >= 1 && at <= kLargestSide_px && size <= kLargestSide_px;
    };
    if (v.size() == 4 && parts.size() == 4 && fits(v[0], v[2]) && fits(v[1], v[3]))
        return Rect{v[0], v[1], v[0] + v[2], v[1] + v[3]};
    refuse(option, text, "x,y,width,height inside the frame, or I/N, one of N bands of it");
}

std::string text_of(const Crop& crop) {
    if (const auto* band = std::get_if<FrameBand>(&crop))
        return fmt::format("{}/{}", band->part, band->of);
    return text_of(std::get<Rect>(crop));
}

void check_inside(const std::string& option, const Rect& crop, V2i frame) {
    if (crop.x1 <= frame.x && crop.y1 <= frame.y) return;
    refuse(option, text_of(crop),
           fmt::format("x,y,width,height inside the {}x{} frame", frame.x, frame.y));
}

SampleRange parse_samples(const std::string& option, const std::string& text, uint32_t most) {
    if (const auto parts = io::split(text, ':'); parts.size() == 2) {
        const auto first = number<uint32_t>(io::trimmed(parts[0])),
                   end = number<uint32_t>(io::trimmed(parts[1]));
        if (first && end && *first < *end && *end <= most) return {*first, *end};
    }
    refuse(option, text,
           fmt::format("a range A:B of samples, from A to before B, with A < B <= {}", most));
}

V2i parse_pixel(const std::string& option, const std::string& text) {
    if (const auto parts = io::split(text, ','); parts.size() == 2) {
        const auto x = number<int>(io::trimmed(parts[0])), y = number<int>(io::trimmed(parts[1]));
        if (x && y) return {*x, *y};
    }
    refuse(option, text, "a pixel x,y");
}

namespace {

/// Units of a duration, the longest first.
struct DurationUnit {
    std::string_view name;
    double s;
};
constexpr std::array<DurationUnit, 5> kDurations{
    {{"h", 3600}, {"min", 60}, {"m", 60}, {"s", 1}, {"ms", 1e-3}}};

// Seconds from "1:30" and "1:02:30", as the progress line writes them.
std::optional<double> clock_s(std::string_view text) {
    const auto parts = io::split(text, ':');
    if (parts.size() < 2 || parts.size() > 3) return std::nullopt;
    double sum_s = 0;
    for (size_t i = 0; i < parts.size(); ++i) {
        const auto value = number<uint32_t>(parts[i]);
        if (!value || (i > 0 && (*value >= 60 || parts[i].size() != 2))) return std::nullopt;
        sum_s = sum_s * 60 + *value;
    }
    return sum_s;
}

// Seconds from numbers with units, each unit once and the longest first: "1h 30m".
std::optional<double> with_units_s(std::string_view text) {
    double sum_s = 0, shortest_s = std::numeric_limits<double>::infinity();
    for (text = io::trimmed(text); !text.empty(); text = io::trimmed(text)) {
        const size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
        const auto value = number<double>(text.substr(0, digits));
        text = io::trimmed(text.substr(digits));
        const std::string_view word = text.substr(0, text.find_first_of("0123456789. "));
        text.remove_prefix(word.size());
        const auto unit = std::find_if(kDurations.begin(), kDurations.end(),
                                       [&](const DurationUnit& one) { return one.name == word; });
        if (!value || unit == kDurations.end() || unit->s >= shortest_s) return std::nullopt;
        shortest_s = unit->s;
        sum_s += *value * unit->s;
    }
    return sum_s;
}

}  // namespace

double parse_duration_s(const std::string& option, const std::string& text) {
    constexpr double longest_s = 1e9;
    std::optional<double> s = number<double>(text);
    if (!s) s = clock_s(text);
    if (!s) s = with_units_s(io::lower(text));
    if (!s || !(*s > 0 && *s <= longest_s))
        refuse(option, text, "a time such as 90s, 1.5m, 1h30m or 1:30");
    return *s;
}

ExposureRequest parse_exposure(const std::string& option, const std::string& text) {
    std::string_view digits = io::trimmed(text);
    if (io::lower(std::string(digits)) == "auto") return {true};
    if (io::lower(std::string(digits)).ends_with("ev"))
        digits = io::trimmed(digits.substr(0, digits.size() - 2));
    const auto value = number<float>(digits);
    if (!value || std::fabs(*value) > kMostExposure_ev)
        refuse(option, text,
               fmt::format("auto or a number from {0:g} to {1:g}", -kMostExposure_ev,
                           kMostExposure_ev));
    return {false, *value};
}

uint64_t parse_memory_bytes(const std::string& option, const std::string& text) {
    constexpr std::array<Unit, 8> units{{{"kB", 1e3},
                                         {"MB", 1e6},
                                         {"GB", 1e9},
                                         {"TB", 1e12},
                                         {"KiB", 0x1p10},
                                         {"MiB", 0x1p20},
                                         {"GiB", 0x1p30},
                                         {"TiB", 0x1p40}}};
    const auto bytes = quantity(text, units);
    if (bytes && !number<double>(io::trimmed(text)) && *bytes >= 1 && *bytes < 0x1p62)
        return static_cast<uint64_t>(*bytes);
    refuse(option, text, "an amount of memory such as 512MB, 8GB or 8GiB");
}

double parse_share(const std::string& option, const std::string& text) {
    const bool per_cent = text.ends_with('%');
    const auto value =
        number<double>(io::trimmed(std::string_view(text).substr(0, text.size() - per_cent)));
    const double share = value.value_or(0) / (per_cent ? 100 : 1);
    if (!(share > 0 && share <= 1))
        refuse(option, text, "a share such as 1% or 0.01, 100% at most");
    return share;
}

Moment parse_moment(const std::string& option, const std::string& text) {
    constexpr double kMost_s = 1e6;
    constexpr std::array<Unit, 4> kSeconds{{{"s"}, {"sec"}, {"ms", 1, 1000}, {"min", 60, 1}}};
    constexpr std::string_view kFrame = "frame:";
    const std::string_view given = io::trimmed(text);
    const bool is_frame = given.starts_with(kFrame);
    const auto value =
        is_frame ? number<double>(given.substr(kFrame.size())) : quantity(given, kSeconds);
    if (value && (is_frame || std::fabs(*value) <= kMost_s)) return {*value, is_frame};
    refuse(option, text, "a time such as 1.25s, 40ms or frame:30");
}

ShutterTime parse_shutter(const std::string& option, const std::string& text) {
    if (!number<double>(io::trimmed(text)))
        if (const auto angle_deg = quantity(text, kDegrees); angle_deg && *angle_deg > 0)
            return {*angle_deg, true};
    std::string_view digits = text;
    const float per_s = digits.ends_with("ms") ? 1000 : 1;
    if (digits.ends_with('s')) digits.remove_suffix(per_s == 1 ? 1 : 2);
    const auto parts = io::split(io::trimmed(digits), '/');
    const auto above = number<float>(parts[0]);
    const auto below = parts.size() == 2 ? number<float>(parts[1]) : std::optional(1.f);
    if (parts.size() <= 2 && above && below)
        if (const float s = *above / *below / per_s; is_shutter_time(s)) return {double(s), false};
    refuse(option, text, kShutterTimes);
}

namespace {

std::optional<float> focus_distance_m(std::string_view text) {
    const std::string word = io::lower(std::string(io::trimmed(text)));
    if (word == "infinity" || word == "inf" || word == "∞")
        return std::numeric_limits<float>::infinity();
    const auto value = quantity(text, kMetres);
    if (!value) return std::nullopt;
    const auto distance_m = static_cast<float>(*value);
    if (distance_m < kNearestFocus_m || distance_m > kFarthestFocus_m) return std::nullopt;
    return distance_m;
}

std::string focus_distances() {
    return fmt::format(
        "a distance of {:g} to {:g} metres, one with a unit (30cm, 2mm, 5ft), infinity",
        kNearestFocus_m, kFarthestFocus_m);
}

}  // namespace

float parse_focus_distance_m(const std::string& option, const std::string& text) {
    const auto distance_m = focus_distance_m(text);
    if (!distance_m) refuse(option, text, focus_distances());
    return *distance_m;
}

Focus parse_focus(const std::string& option, const std::string& text) {
    if (io::lower(text) == "auto") return FocusAuto{};
    if (const auto parts = io::split(text, ','); parts.size() == 2) {
        const auto x = number<int>(io::trimmed(parts[0])), y = number<int>(io::trimmed(parts[1]));
        if (x && y && *x >= 0 && *y >= 0) return FocusPixel{*x, *y};
        refuse(option, text, "a pixel x,y of the frame");
    }
    const auto distance_m = focus_distance_m(text);
    if (!distance_m) refuse(option, text, focus_distances() + ", a pixel x,y or auto");
    return FocusDistance{*distance_m};
}

void check_inside(const std::string& option, const Focus& focus, V2i frame) {
    const auto* pixel = std::get_if<FocusPixel>(&focus);
    if (pixel && !(pixel->x < frame.x && pixel->y < frame.y))
        refuse(option, fmt::format("{},{}", pixel->x, pixel->y),
               fmt::format("a pixel x,y of the {}x{} frame", frame.x, frame.y));
}

Bins parse_bins(const std::string& option, const std::string& text) {
    constexpr int most = 1024;  // more channels than readers of EXR expect
    // A wavelength is a float, which has steps of 0.00006 nm: narrower bins would show them.
    constexpr double narrowest_nm = 0.1;
    const auto parts = io::split(text, ':');
    std::vector<double> v;
    for (const std::string_view part : parts)
        if (const auto value = quantity(part, kNanometres)) v.push_back(*value);
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

std::vector<std::string> layer_names() {
    std::vector<std::string> names;
    for (int i = 0; i < static_cast<int>(Aov::Count); ++i)
        names.emplace_back(aov_info(static_cast<Aov>(i)).name);
    return names;
}

void add_aovs(const std::string& option, const std::string& list, std::vector<Aov>& layers) {
    const std::vector<std::string> known = layer_names();
    for (const std::string_view part : io::split(list, ',')) {
        const std::string name = io::lower(std::string(io::trimmed(part)));
        const auto aov = aov_from_name(name);
        if (!aov)
            refuse(option, name,
                   fmt::format("a layer; there are {}{}", fmt::join(known, ", "),
                               io::did_you_mean(name, known)));
        if (std::find(layers.begin(), layers.end(), *aov) == layers.end()) layers.push_back(*aov);
    }
}

std::array<V3f, 2> parse_look_at(const std::string& option, const std::string& text) {
    constexpr float kNearest_m = 1e-12f;
    const auto v = parse_lengths_m(option, text, 6);
    for (const float x : v) require_near(option, x);
    const std::array<V3f, 2> aim{V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5])};
    if ((aim[0] - aim[1]).length() < kNearest_m)
        throw ValueError(option, "eye and target are the same point");
    return aim;
}

M44f parse_pose(const std::string& option, const std::string& text) {
    constexpr float kSlack = 1e-3f;  ///< matrices are written with few digits
    const auto v = parse_numbers(option, text, 12);
    M44f pose;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) pose[column][row] = v[size_t(4 * row + column)];
    const V3f right(pose[0][0], pose[0][1], pose[0][2]), up(pose[1][0], pose[1][1], pose[1][2]),
        back(pose[2][0], pose[2][1], pose[2][2]);
    for (const V3f& axis : {right, up, back})
        if (std::fabs(axis.length() - 1) > kSlack)
            throw ValueError(
                option,
                fmt::format("its columns 1 to 3 must have length 1, not {:.4g}", axis.length()));
    for (const float cosine : {right.dot(up), up.dot(back), back.dot(right)})
        if (std::fabs(cosine) > kSlack)
            throw ValueError(option, "its columns 1 to 3 must be square to each other");
    if (right.cross(up).dot(back) < 0)
        throw ValueError(option, "mirrors: its columns must point right, up and back");
    for (int i = 0; i < 3; ++i) require_near(option, pose[3][i]);
    return pose;
}

std::string text_of_pose(const M44f& pose) {
    std::string text;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            text += fmt::format("{}{}", text.empty() ? "" : ",", pose[column][row]);
    return text;
}

std::vector<int> parse_frames(const std::string& option, const std::string& text) {
    constexpr int kMostFrames = 100'000, kLastFrame = 10'000'000;
    std::vector<int> numbers;
    for (const std::string_view part : io::split(text, ':'))
        numbers.push_back(number<int>(io::trimmed(part)).value_or(-1));
    const bool right =
        numbers.size() <= 3 && std::all_of(numbers.begin(), numbers.end(),
                                           [](int n) { return n >= 0 && n <= kLastFrame; });
    const int first = numbers[0], last = numbers.size() > 1 ? numbers[1] : first,
              step = numbers.size() > 2 ? numbers[2] : 1;
    if (!right || last < first || step < 1 || (last - first) / step >= kMostFrames)
        refuse(option, text,
               fmt::format("a range of frames such as 1:48, 1:48:2 or 7, {} at most", kMostFrames));
    std::vector<int> frames;
    for (int frame = first; frame <= last; frame += step) frames.push_back(frame);
    return frames;
}

Sweep parse_sweep(const std::string& option, const std::string& text) {
    const size_t at = text.find('=');
    Sweep sweep;
    if (at != text.npos && at > 0 && text[0] != '-') {
        sweep.field = text.substr(0, at);
        const std::string values = text.substr(at + 1);
        for (const std::string_view part :
             io::split(values, values.find(';') == values.npos ? ',' : ';'))
            sweep.values.emplace_back(io::trimmed(part));
    }
    if (sweep.values.empty() || std::ranges::find(sweep.values, "") != sweep.values.end())
        refuse(option, text,
               "an option and its values, as fstop=1.4,2,2.8; with semicolons between values that "
               "hold commas");
    return sweep;
}

}  // namespace petzval::apps
