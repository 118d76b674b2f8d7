// SPDX-License-Identifier: Apache-2.0
// Tiny JPEG files for tests, of every kind, without a JPEG library: blocks of 8x8 pixels that are
// each of one value, which then comes out exactly.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace petzval {

struct TinyJpeg {
    int blocks_across = 1, blocks_down = 1;
    /// Value of each block, row by row, of each component: one (grey), three or four.
    std::vector<std::vector<int>> components;
    bool progressive = false;
    int bits = 8;
    std::optional<int> adobe_transform{};          ///< 0: as is, 1: YCbCr, 2: YCCK; none: no APP14
    std::vector<std::vector<uint8_t>> segments{};  ///< whole ones, right behind the start
};

/// A segment: marker, length, content.
inline std::vector<uint8_t> jpeg_segment(uint8_t marker, const std::vector<uint8_t>& content) {
    const size_t size = content.size() + 2;
    std::vector<uint8_t> out = {0xFF, marker, uint8_t(size >> 8), uint8_t(size)};
    out.insert(out.end(), content.begin(), content.end());
    return out;
}

/// An APP1 segment of Exif with nothing but an orientation (Exif 2.3, section 4.6).
inline std::vector<uint8_t> jpeg_orientation(uint8_t orientation) {
    return jpeg_segment(
        0xE1, {'E', 'x', 'i', 'f',  0, 0, 'M', 'M', 0, 42, 0, 0,           0, 8,  // TIFF
               0,   1,   1,   0x12, 0, 3, 0,   0,   0, 1,  0, orientation, 0, 0,  // one entry
               0,   0,   0,   0});
}

/// Bits of a scan, with a zero byte behind each 0xFF.
class JpegBits {
  public:
    void put(uint32_t value, int count) {
        for (int i = count - 1; i >= 0; --i) put_bit(value >> i & 1);
    }
    std::vector<uint8_t> finish() {
        while (used_ != 0) put_bit(1);
        return bytes_;
    }

  private:
    void put_bit(uint32_t bit) {
        last_ = last_ << 1 | bit;
        if (++used_ < 8) return;
        bytes_.push_back(uint8_t(last_));
        if (bytes_.back() == 0xFF) bytes_.push_back(0);
        used_ = 0;
    }
    std::vector<uint8_t> bytes_;
    uint32_t last_ = 0;
    int used_ = 0;
};

/// ITU-T T.81. Every code of the DC table has 4 bits and stands for as many more; the AC table has
/// one code of one bit, the end of a block.
inline std::vector<uint8_t> tiny_jpeg(const TinyJpeg& in) {
    std::vector<uint8_t> out = {0xFF, 0xD8};
    const auto add = [&](const std::vector<uint8_t>& bytes) {
        out.insert(out.end(), bytes.begin(), bytes.end());
    };
    for (const std::vector<uint8_t>& segment : in.segments) add(segment);
    if (in.adobe_transform)
        add(jpeg_segment(
            0xEE, {'A', 'd', 'o', 'b', 'e', 0, 100, 0, 0, 0, 0, uint8_t(*in.adobe_transform)}));
    std::vector<uint8_t> quantisers(65, 1);
    quantisers[0] = 0;
    add(jpeg_segment(0xDB, quantisers));
    const auto count = uint8_t(in.components.size());
    const int width = 8 * in.blocks_across, height = 8 * in.blocks_down;
    std::vector<uint8_t> frame = {uint8_t(in.bits),    uint8_t(height >> 8), uint8_t(height),
                                  uint8_t(width >> 8), uint8_t(width),       count};
    for (uint8_t c = 0; c < count; ++c) frame.insert(frame.end(), {uint8_t(c + 1), 0x11, 0});
    add(jpeg_segment(in.progressive ? 0xC2 : in.bits > 8 ? 0xC1 : 0xC0, frame));
    std::vector<uint8_t> dc(17, 0), ac(17, 0);
    dc[4] = 14;
    for (uint8_t i = 0; i < 14; ++i) dc.push_back(i);
    ac[0] = 0x10;
    ac[1] = 1;
    ac.push_back(0);
    add(jpeg_segment(0xC4, dc));
    add(jpeg_segment(0xC4, ac));

    const int blocks = in.blocks_across * in.blocks_down;
    const auto scan = [&](std::vector<uint8_t> which, int first, int last, auto put_block) {
        std::vector<uint8_t> header = {uint8_t(which.size())};
        for (const uint8_t c : which) header.insert(header.end(), {uint8_t(c + 1), 0});
        header.insert(header.end(), {uint8_t(first), uint8_t(last), 0});
        add(jpeg_segment(0xDA, header));
        JpegBits bits;
        for (int b = 0; b < blocks; ++b)
            for (const uint8_t c : which) put_block(bits, c, b);
        add(bits.finish());
    };
    std::vector<int> before(count, 1 << (in.bits - 1));
    const auto put_dc = [&](JpegBits& bits, uint8_t c, int b) {
        const int value = in.components[c][size_t(b)], step = 8 * (value - before[c]);
        before[c] = value;
        int size = 0;
        while ((step < 0 ? -step : step) >> size) ++size;
        bits.put(uint32_t(size), 4);
        bits.put(uint32_t(step < 0 ? step + (1 << size) - 1 : step), size);
    };
    const auto end_block = [](JpegBits& bits, uint8_t, int) { bits.put(0, 1); };
    std::vector<uint8_t> all;
    for (uint8_t c = 0; c < count; ++c) all.push_back(c);
    if (in.progressive) {
        scan(all, 0, 0, put_dc);
        for (const uint8_t c : all) scan({c}, 1, 63, end_block);
    } else {
        scan(all, 0, 63, [&](JpegBits& bits, uint8_t c, int b) {
            put_dc(bits, c, b);
            end_block(bits, c, b);
        });
    }
    add({0xFF, 0xD9});
    return out;
}

}  // namespace petzval
