// SPDX-License-Identifier: Apache-2.0
#include "io/image/spectral_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "io/base/error.h"

namespace petzval::io {
namespace {

constexpr std::string_view kPrefix = "S0.";
constexpr double kSpeedOfLight_m_per_s = 299792458;  // exact, by the definition of the metre

/// Powers of ten of the prefixes that the layout allows.
constexpr std::array<std::pair<std::string_view, int>, 17> kPowers{{{"", 0},
                                                                    {"Y", 24},
                                                                    {"Z", 21},
                                                                    {"E", 18},
                                                                    {"P", 15},
                                                                    {"T", 12},
                                                                    {"G", 9},
                                                                    {"M", 6},
                                                                    {"k", 3},
                                                                    {"h", 2},
                                                                    {"da", 1},
                                                                    {"d", -1},
                                                                    {"c", -2},
                                                                    {"m", -3},
                                                                    {"u", -6},
                                                                    {"n", -9},
                                                                    {"p", -12}}};

/// Removes an ending from a text; false where it has another.
bool cut(std::string_view& text, std::string_view end) {
    if (!text.ends_with(end)) return false;
    text.remove_suffix(end.size());
    return true;
}

/// Wavelength in nm of a number of some 10^power metres or hertz.
double to_nm(double value, int power, bool hertz) {
    // Powers of ten above 1 are exact, those below are not.
    const auto scaled = [&](int by) {
        return by < 0 ? value / std::pow(10., -by) : value * std::pow(10., by);
    };
    return hertz ? kSpeedOfLight_m_per_s / scaled(power) * 1e9 : scaled(power + 9);
}

}  // namespace

std::string spectral_channel(double nm) {
    std::string number = fmt::format("{:.3f}", nm);
    while (number.ends_with("0") && !number.ends_with(".0")) number.pop_back();
    number[number.find('.')] = ',';
    return fmt::format("{}{}nm", kPrefix, number);
}

std::optional<double> spectral_channel_nm(std::string_view name) {
    if (!name.starts_with(kPrefix)) return std::nullopt;
    name.remove_prefix(kPrefix.size());
    const bool hertz = cut(name, "Hz");
    if (!hertz && !cut(name, "m")) return std::nullopt;
    std::string number(name);
    if (number.empty() || number.find_first_not_of("0123456789,") == 0 ||
        number.find('.') != std::string::npos)
        return std::nullopt;
    if (const size_t comma = number.find(','); comma != std::string::npos) number[comma] = '.';
    double value = 0;
    const char* const end = number.data() + number.size();
    const auto [rest, error] = std::from_chars(number.data(), end, value);
    if (error != std::errc()) return std::nullopt;
    for (const auto& [prefix, power] : kPowers)
        if (prefix == std::string_view(rest, size_t(end - rest))) {
            const double nm = to_nm(value, power, hertz);
            return nm > 0 && std::isfinite(nm) ? std::optional(nm) : std::nullopt;
        }
    return std::nullopt;
}

std::vector<SpectralChannel> spectral_channels(const PictureLayout& picture,
                                               std::string_view layer) {
    std::vector<SpectralChannel> found;
    for (size_t i = 0; i < picture.channels.size(); ++i) {
        std::string_view name = picture.channels[i];
        if (!name.starts_with(layer)) continue;
        name.remove_prefix(layer.size());
        if (const auto nm = spectral_channel_nm(name)) found.push_back({*nm, i});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.nm < b.nm; });
    return found;
}

PixelSpectra spectra_of_pixel(const Picture& picture, const std::filesystem::path& file, int x,
                              int y) {
    if (spectral_channels(picture).empty())
        throw ArgumentError(
            file.string(), "",
            "is not spectral, it has no channels S0; render with ⟨bins⟩ to get one");
    const int64_t column = int64_t{x} - picture.x, row = int64_t{y} - picture.y;
    if (column < 0 || row < 0 || column >= picture.width || row >= picture.height)
        throw ArgumentError(file.string(), "", "has no pixel {},{}; it has {},{} to {},{}", x, y,
                            picture.x, picture.y, picture.x + picture.width - 1,
                            picture.y + picture.height - 1);
    const size_t pixel = size_t(row) * size_t(picture.width) + size_t(column);
    const auto spectrum = [&](std::string_view layer) {
        std::vector<std::array<double, 2>> out;
        for (const auto& [nm, index] : spectral_channels(picture, layer))
            out.push_back({nm, picture.pixels[pixel * picture.channels.size() + index]});
        return out;
    };
    return {spectrum(""), spectrum("denoised.")};
}

}  // namespace petzval::io
