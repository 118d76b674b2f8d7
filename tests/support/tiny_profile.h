// SPDX-License-Identifier: Apache-2.0
// Tiny ICC profiles for tests (ICC.1:2022, section 7): three primaries, one curve, and a name.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/tiny_png.h"

namespace petzval {

using Primaries = std::array<std::array<double, 3>, 3>;
/// X, Y, Z under D50 of red, green and blue of sRGB, and of Adobe RGB (1998).
inline constexpr Primaries kSrgbPrimaries = {
    {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}}};
inline constexpr Primaries kAdobePrimaries = {
    {{0.60974, 0.31111, 0.01947}, {0.20528, 0.62567, 0.06087}, {0.14919, 0.06322, 0.74457}}};

/// A profile whose curve is a gamma.
inline std::vector<uint8_t> tiny_profile(const Primaries& primaries, double gamma,
                                         const std::string& name) {
    std::vector<std::pair<std::string, std::vector<uint8_t>>> tags;
    const auto typed = [](const char* type) {
        return std::vector<uint8_t>{
            uint8_t(type[0]), uint8_t(type[1]), uint8_t(type[2]), uint8_t(type[3]), 0, 0, 0, 0};
    };
    std::vector<uint8_t> about = typed("desc");
    put_big_endian(about, uint32_t(name.size() + 1));
    about.insert(about.end(), name.begin(), name.end());
    about.resize(about.size() + 1 + 78 + 4 - (name.size() + 1) % 4);
    tags.emplace_back("desc", about);
    for (size_t i = 0; i < 3; ++i) {
        std::vector<uint8_t> xyz = typed("XYZ ");
        for (const double value : primaries[i])
            put_big_endian(xyz, uint32_t(int32_t(value * 65536)));
        tags.emplace_back(std::string(1, "rgb"[i]) + "XYZ", xyz);
        std::vector<uint8_t> curve = typed("curv");
        put_big_endian(curve, 1);
        const auto fixed = uint16_t(gamma * 256);
        curve.insert(curve.end(), {uint8_t(fixed >> 8), uint8_t(fixed), 0, 0});
        tags.emplace_back(std::string(1, "rgb"[i]) + "TRC", curve);
    }
    std::vector<uint8_t> white = typed("XYZ ");
    for (const double value : {0.9642, 1., 0.8249})
        put_big_endian(white, uint32_t(int32_t(value * 65536)));
    tags.emplace_back("wtpt", white);

    std::vector<uint8_t> body, table;
    put_big_endian(table, uint32_t(tags.size()));
    const size_t start = 128 + 4 + 12 * tags.size();
    for (const auto& [tag, content] : tags) {
        table.insert(table.end(), tag.begin(), tag.end());
        put_big_endian(table, uint32_t(start + body.size()));
        put_big_endian(table, uint32_t(content.size()));
        body.insert(body.end(), content.begin(), content.end());
    }
    std::vector<uint8_t> profile;
    put_big_endian(profile, uint32_t(start + body.size()));
    for (const char* word : {"none", "\2\x10\0\0", "mntr", "RGB ", "XYZ "})
        profile.insert(profile.end(), word, word + 4);
    profile.resize(36);
    for (const char c : {'a', 'c', 's', 'p'}) profile.push_back(uint8_t(c));
    profile.resize(68);
    for (const double value : {0.9642, 1., 0.8249})
        put_big_endian(profile, uint32_t(int32_t(value * 65536)));
    profile.resize(128);
    profile.insert(profile.end(), table.begin(), table.end());
    profile.insert(profile.end(), body.begin(), body.end());
    return profile;
}

/// The chunk iCCP of a PNG.
inline std::vector<uint8_t> png_profile_chunk(const std::vector<uint8_t>& profile) {
    std::vector<uint8_t> data = {'a', 0, 0}, chunk;
    const std::vector<uint8_t> packed = zlib_stored(profile);
    data.insert(data.end(), packed.begin(), packed.end());
    put_png_chunk(chunk, "iCCP", data);
    return chunk;
}

}  // namespace petzval
