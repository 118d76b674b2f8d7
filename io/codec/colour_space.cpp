// SPDX-License-Identifier: Apache-2.0
#include "io/codec/colour_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "io/base/printable.h"

namespace petzval::io::codec {
namespace {

using Bytes = std::span<const uint8_t>;

/// Difference that nobody sees, and that rounding in a file may make.
constexpr double kSame = 0.01;
/// Exponent of gAMA for sRGB: PNG, third edition, section 11.3.2.5. Files that were made for 2.2
/// have the same.
constexpr double kSrgbGamma = 1 / 2.2;

std::optional<uint32_t> word(Bytes bytes, size_t at) {
    if (at > bytes.size() || bytes.size() - at < 4) return std::nullopt;
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
    return value;
}
Bytes part(Bytes bytes, size_t at, size_t size) {
    if (at > bytes.size() || size > bytes.size() - at) return {};
    return bytes.subspan(at, size);
}
std::string_view text(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
bool differ(double a, double b) {
    return std::fabs(a - b) > kSame;
}

/// Content of a tag of a profile; empty where it has none.
Bytes tag(Bytes profile, std::string_view name) {
    constexpr size_t header = 128, most_tags = 100;
    const size_t count = std::min<size_t>(word(profile, header).value_or(0), most_tags);
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = header + 4 + 12 * i;
        if (text(part(profile, entry, 4)) == name)
            return part(profile, word(profile, entry + 4).value_or(0),
                        word(profile, entry + 8).value_or(0));
    }
    return {};
}

/// s15Fixed16Number.
double fixed(Bytes bytes, size_t at) {
    return double(static_cast<int32_t>(word(bytes, at).value_or(0))) / 65536;
}

/// Value of a tone curve at 1/2; nothing for one of another kind.
std::optional<double> middle_of_curve(Bytes curve) {
    const std::string_view kind = text(part(curve, 0, 4));
    const auto number = [&](size_t at) { return double(curve[at] << 8 | curve[at + 1]); };
    if (kind == "curv") {
        const uint32_t count = word(curve, 8).value_or(0);
        if (count == 0) return 0.5;
        const size_t at = 12 + 2 * size_t{count > 1 ? (count - 1) / 2 : 0};
        if (part(curve, at, 4).empty() && part(curve, at, 2).empty()) return std::nullopt;
        return count == 1 ? std::pow(0.5, number(at) / 256) : number(at) / 65535;
    }
    if (kind != "para" || curve.size() < 16) return std::nullopt;
    const int function = int(number(8));
    const double g = fixed(curve, 12), a = fixed(curve, 16), b = fixed(curve, 20);
    if (function == 0) return std::pow(0.5, g);
    const double added = function == 2 ? fixed(curve, 24) : function == 4 ? fixed(curve, 32) : 0;
    return std::pow(std::max(a * 0.5 + b, 0.), g) + added;
}

std::string description(Bytes profile) {
    const Bytes about = tag(profile, "desc");
    std::string name;
    if (text(part(about, 0, 4)) == "desc") {
        name = text(part(about, 12, word(about, 8).value_or(0)));
    } else if (text(part(about, 0, 4)) == "mluc") {  // UTF-16, of which ASCII is shown
        const Bytes wide = part(about, word(about, 24).value_or(0), word(about, 20).value_or(0));
        for (size_t i = 1; i < wide.size(); i += 2)
            name += wide[i - 1] == 0 && wide[i] < 128 ? char(wide[i]) : '?';
    }
    name.resize(std::min(name.find('\0'), name.size()));
    constexpr size_t longest = 60;
    if (name.size() > longest) name.resize(longest);
    return name.empty() ? "a profile without a name" : "the profile " + printable(name);
}

std::string space_of_chromaticities(Bytes chrm) {
    // sRGB: white, red, green, blue (IEC 61966-2-1).
    constexpr std::array expected = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
    for (size_t i = 0; i < expected.size(); ++i)
        if (differ(word(chrm, 4 * i).value_or(0) / 1e5, expected[i]))
            return "primaries of its own (cHRM)";
    return "";
}

}  // namespace

std::string other_space_of_profile(Bytes profile) {
    if (profile.empty()) return "";
    if (text(part(profile, 16, 4)) == "GRAY") {
        const auto middle = middle_of_curve(tag(profile, "kTRC"));
        return middle && !differ(*middle, 0.2140) ? "" : description(profile);
    }
    // Primaries of sRGB adapted to D50, which is the white of profiles: X, Y, Z of each.
    constexpr std::array<std::array<double, 3>, 3> primaries = {
        {{0.4361, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1431, 0.0606, 0.7141}}};
    constexpr std::array<std::string_view, 3> colours = {"rXYZ", "gXYZ", "bXYZ"};
    for (size_t i = 0; i < 3; ++i) {
        const Bytes xyz = tag(profile, colours[i]);
        for (size_t k = 0; k < 3; ++k)
            if (differ(fixed(xyz, 8 + 4 * k), primaries[i][k])) return description(profile);
    }
    const auto middle = middle_of_curve(tag(profile, "rTRC"));
    return middle && !differ(*middle, 0.2140) ? "" : description(profile);
}

std::string other_space_of_png(Bytes file, Bytes profile) {
    std::map<std::string_view, Bytes> chunks;
    for (size_t at = 8;;) {
        const auto length = word(file, at);
        const std::string_view kind = text(part(file, at + 4, 4));
        if (!length || kind == "IDAT" || kind.empty()) break;
        chunks.try_emplace(kind, part(file, at + 8, *length));
        at += 12 + size_t{*length};
    }
    if (const auto cicp = chunks.find("cICP"); cicp != chunks.end() && cicp->second.size() == 4) {
        // Primaries and curve by the numbers of ITU-T H.273: 1 and 13 are sRGB's.
        const int primaries = cicp->second[0], curve = cicp->second[1];
        if (primaries == 1 && curve == 13) return "";
        return fmt::format("primaries {} and curve {} of ITU-T H.273 (cICP)", primaries, curve);
    }
    if (!profile.empty()) return other_space_of_profile(profile);
    if (chunks.contains("sRGB")) return "";
    if (const auto gama = chunks.find("gAMA"); gama != chunks.end()) {
        const double exponent = word(gama->second, 0).value_or(0) / 1e5;
        if (exponent > 0 && differ(exponent, kSrgbGamma))
            return fmt::format("a gamma of {:.3g} (gAMA)", 1 / exponent);
    }
    const auto chrm = chunks.find("cHRM");
    return chrm == chunks.end() ? "" : space_of_chromaticities(chrm->second);
}

}  // namespace petzval::io::codec
