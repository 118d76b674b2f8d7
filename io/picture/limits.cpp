// SPDX-License-Identifier: Apache-2.0
#include "io/picture/limits.h"

#include <fmt/format.h>

#include <string_view>

namespace petzval::io {
namespace {

constexpr int kMaxSide = 32768;
// Most values that a byte of a file may stand for: Deflate packs at most 1032 bytes into one (RFC
// 1951: 258 bytes in two bits), and each may be the index of four palette values. Files that claim
// more are broken, or made to fill the memory.
constexpr uint64_t kMaxValuesPerByte = 4 * 1032;
// Values that a file of any size may claim, 4096 x 4096 pixels: some formats need next to no bytes
// for a picture of one colour.
constexpr uint64_t kHarmlessValues = uint64_t{4} * 4096 * 4096;

}  // namespace

std::optional<std::array<int, 2>> webp_size(std::span<const uint8_t> file) {
    constexpr size_t needed = 30;
    if (file.size() < needed) return std::nullopt;
    const std::string_view text(reinterpret_cast<const char*>(file.data()), needed);
    if (!text.starts_with("RIFF") || text.substr(8, 4) != "WEBP") return std::nullopt;
    const auto word = [&](size_t at, int bytes) {
        int value = 0;
        for (int i = bytes; i-- > 0;) value = value << 8 | file[at + size_t(i)];
        return value;
    };
    const std::string_view chunk = text.substr(12, 4);
    if (chunk == "VP8X") return std::array{word(24, 3) + 1, word(27, 3) + 1};
    if (chunk == "VP8 ") return std::array{word(26, 2) & 0x3FFF, word(28, 2) & 0x3FFF};
    if (chunk != "VP8L") return std::nullopt;
    return std::array{(word(21, 2) & 0x3FFF) + 1, (word(22, 3) >> 6 & 0x3FFF) + 1};
}

std::string size_complaint(int width, int height, int depth, int channels, uint64_t byte_count) {
    if (width <= 0 || height <= 0 || channels <= 0)
        return fmt::format("is {}x{} pixels with {} channels and holds nothing", width, height,
                           channels);
    if (depth > 1) return fmt::format("is a volume {} slices deep; use a flat picture", depth);
    if (width > kMaxSide || height > kMaxSide)
        return fmt::format("is {}x{} pixels, more than {} on a side; scale it down", width, height,
                           kMaxSide);
    const uint64_t values = uint64_t(width) * height * channels;
    if (values > kHarmlessValues && values / kMaxValuesPerByte > byte_count)
        return fmt::format("claims {}x{} pixels with {} channels in {} bytes, which cannot be",
                           width, height, channels, byte_count);
    return "";
}

}  // namespace petzval::io
