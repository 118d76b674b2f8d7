// SPDX-License-Identifier: Apache-2.0
// Small pictures for tests, and a Radiance file byte by byte.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "io/picture/picture.h"

namespace petzval::test {

/// A whole frame of these channels; pixels may be given, else they are 0.
[[nodiscard]] inline io::Picture picture(int width, int height, std::vector<std::string> channels,
                                         std::vector<float> pixels = {}) {
    if (pixels.empty()) pixels.resize(size_t(width) * height * channels.size());
    return {{.width = width,
             .height = height,
             .full_width = width,
             .full_height = height,
             .channels = std::move(channels),
             .metadata = {}},
            std::move(pixels)};
}

/// Every row of a picture.
[[nodiscard]] inline io::Picture held(const io::PictureRows& rows) {
    io::Picture p{rows.layout, {}};
    const size_t row = size_t(p.width) * p.channels.size();
    p.pixels.resize(row * size_t(p.height));
    for (int y = 0; y < p.height; ++y) rows.row(y, p.pixels.data() + size_t(y) * row);
    return p;
}

/// The same with random values in [0, 1).
[[nodiscard]] inline io::Picture noise(int width, int height, std::vector<std::string> channels) {
    io::Picture p = picture(width, height, std::move(channels));
    std::minstd_rand random(7);
    for (float& value : p.pixels) value = float(random() % 4096) / 4096.f;
    return p;
}

/// Radiance RGBE without run lengths: Ward 1991, "Real Pixels", Graphics Gems II. Each texel is
/// three mantissas and an exponent: mantissa / 256 * 2^(exponent - 128).
[[nodiscard]] inline std::vector<uint8_t> radiance_file(int width, int height,
                                                        const std::vector<uint8_t>& rgbe) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                               std::to_string(height) + " +X " + std::to_string(width) + "\n";
    std::vector<uint8_t> file(header.begin(), header.end());
    file.insert(file.end(), rgbe.begin(), rgbe.end());
    return file;
}

}  // namespace petzval::test
