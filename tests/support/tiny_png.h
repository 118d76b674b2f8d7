// SPDX-License-Identifier: Apache-2.0
// Tiny PNG files for tests, of every kind, without a PNG library.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace petzval {

enum class PngColour : uint8_t { Grey = 0, Rgb = 2, Palette = 3, GreyAlpha = 4, Rgba = 6 };

inline void put_big_endian(std::vector<uint8_t>& to, uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(uint8_t(word >> shift));
}

/// CRC-32 of a PNG chunk: its polynomial bit by bit (PNG, third edition, annex D).
inline uint32_t png_crc(std::span<const uint8_t> bytes) {
    uint32_t crc = ~0u;
    for (uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    return ~crc;
}

inline void put_png_chunk(std::vector<uint8_t>& to, std::string_view type,
                          std::span<const uint8_t> data) {
    put_big_endian(to, uint32_t(data.size()));
    const size_t start = to.size();
    to.insert(to.end(), type.begin(), type.end());
    to.insert(to.end(), data.begin(), data.end());
    put_big_endian(to, png_crc(std::span(to).subspan(start)));
}

/// One stored block (RFC 1951, section 3.2.4) in a zlib stream (RFC 1950); at most 65535 bytes.
inline std::vector<uint8_t> zlib_stored(std::span<const uint8_t> bytes) {
    const auto size = uint16_t(bytes.size());
    std::vector<uint8_t> stream = {0x78, 0x01, 0x01, uint8_t(size), uint8_t(size >> 8)};
    stream.push_back(uint8_t(~size));
    stream.push_back(uint8_t(uint16_t(~size) >> 8));
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    uint32_t a = 1, b = 0;
    for (uint8_t byte : bytes) a = (a + byte) % 65521, b = (b + a) % 65521;
    put_big_endian(stream, b << 16 | a);
    return stream;
}

/// rows: the bytes of each row as PNG packs them, row 0 at the top. extra: whole chunks that stand
/// between header and data. interlace: 1 where the rows are those of the passes of Adam7. Nothing
/// is checked, so that broken files can be made too.
inline std::vector<uint8_t> tiny_png(uint32_t width, uint32_t height, uint8_t bits,
                                     PngColour colour,
                                     const std::vector<std::vector<uint8_t>>& rows,
                                     const std::vector<uint8_t>& extra = {},
                                     uint8_t interlace = 0) {
    std::vector<uint8_t> header, data;
    put_big_endian(header, width);
    put_big_endian(header, height);
    header.insert(header.end(), {bits, uint8_t(colour), 0, 0, interlace});
    for (const std::vector<uint8_t>& row : rows) {
        data.push_back(0);  // no filter
        data.insert(data.end(), row.begin(), row.end());
    }
    std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    put_png_chunk(png, "IHDR", header);
    png.insert(png.end(), extra.begin(), extra.end());
    put_png_chunk(png, "IDAT", zlib_stored(data));
    put_png_chunk(png, "IEND", {});
    return png;
}

/// An 8-bit RGBA PNG of width * height texels, row 0 at the top; at most 16000 texels.
inline std::vector<uint8_t> tiny_png(uint32_t width, uint32_t height,
                                     const std::vector<uint8_t>& rgba) {
    std::vector<std::vector<uint8_t>> rows;
    for (uint32_t y = 0; y < height; ++y)
        rows.emplace_back(rgba.begin() + y * width * 4, rgba.begin() + (y + 1) * width * 4);
    return tiny_png(width, height, 8, PngColour::Rgba, rows);
}

}  // namespace petzval
