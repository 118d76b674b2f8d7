// SPDX-License-Identifier: Apache-2.0
// PNG files byte by byte, of kinds that no writer of ours makes. ISO/IEC 15948:2004, RFC 1950,
// 1951.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace petzval::test {

using Bytes = std::vector<uint8_t>;

/// Colour types of PNG.
enum class PngColour : uint8_t { Grey = 0, Rgb = 2, Palette = 3, GreyAlpha = 4, Rgba = 6 };

inline void append_u32(Bytes& to, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(uint8_t(value >> shift));
}

/// Length, type, data and CRC-32 (polynomial 0xedb88320, reflected).
[[nodiscard]] inline Bytes png_chunk(const std::string& type, const Bytes& data) {
    Bytes chunk;
    append_u32(chunk, uint32_t(data.size()));
    chunk.insert(chunk.end(), type.begin(), type.end());
    chunk.insert(chunk.end(), data.begin(), data.end());
    uint32_t crc = ~0u;
    for (size_t i = 4; i < chunk.size(); ++i) {
        crc ^= chunk[i];
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? 0xedb88320u : 0u);
    }
    append_u32(chunk, ~crc);
    return chunk;
}

/// A zlib stream of one block that is not compressed: at most 65535 bytes.
[[nodiscard]] inline Bytes zlib_stored(const Bytes& data) {
    const auto size = uint16_t(data.size());
    Bytes out{
        0x78, 0x01, 0x01, uint8_t(size), uint8_t(size >> 8), uint8_t(~size), uint8_t(~size >> 8)};
    out.insert(out.end(), data.begin(), data.end());
    uint32_t a = 1, b = 0;  // Adler-32
    for (const uint8_t byte : data) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    append_u32(out, b << 16 | a);
    return out;
}

/// A whole file. rows: each row's bytes as PNG packs them, one after another; extra: chunks between
/// header and data.
[[nodiscard]] inline Bytes tiny_png(uint32_t width, uint32_t height, uint8_t bits, PngColour colour,
                                    const std::vector<Bytes>& rows, const Bytes& extra = {}) {
    Bytes header;
    append_u32(header, width);
    append_u32(header, height);
    header.insert(header.end(), {bits, uint8_t(colour), 0, 0, 0});
    Bytes filtered;
    for (const Bytes& row : rows) {
        filtered.push_back(0);  // no filter
        filtered.insert(filtered.end(), row.begin(), row.end());
    }
    Bytes png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const Bytes& part : {png_chunk("IHDR", header), extra,
                              png_chunk("IDAT", zlib_stored(filtered)), png_chunk("IEND", {})})
        png.insert(png.end(), part.begin(), part.end());
    return png;
}

}  // namespace petzval::test
