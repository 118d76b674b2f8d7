// SPDX-License-Identifier: Apache-2.0
#include "io/picture/seal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "io/file/read_file.h"
#include "io/picture/picture_kind.h"

namespace petzval::io {
namespace {

using Bytes = std::vector<uint8_t>;

/// First bytes of a file, where its metadata lie, and bytes that are read at once.
constexpr size_t kPart = 1 << 20;

/// Calls f(place) for each place of a text in bytes.
template <class F>
void each_place(Bytes& bytes, std::string_view text, const F& f) {
    for (auto at = bytes.begin();
         (at = std::search(at, bytes.end(), text.begin(), text.end())) != bytes.end();
         at += std::ptrdiff_t(text.size()))
        f(at);
}

/// Filled value for a file whose first bytes are `head`.
template <class File>
std::string seal_of(const Bytes& head, File& file) {
    uint64_t hash = fnv1a(head);
    Bytes part(kPart);
    for (uint64_t at = head.size(); part.size() == kPart; at += part.size()) {
        part.resize(file.read(part, at));
        hash = fnv1a(part, hash);
    }
    return fmt::format("fnv1a-{:016x}", hash);
}

template <class File>
Bytes head_of(File& file) {
    Bytes head(kPart);
    head.resize(file.read(head, 0));
    return head;
}

/// CRC-32 of a PNG's chunk (annex D of its specification, the W3C's).
uint32_t crc32(std::span<const uint8_t> bytes) {
    static constexpr auto kTable = [] {
        std::array<uint32_t, 256> table{};
        for (uint32_t n = 0; n < table.size(); ++n) {
            table[n] = n;
            for (int bit = 0; bit < 8; ++bit)
                table[n] = (table[n] & 1 ? 0xEDB88320u : 0) ^ table[n] >> 1;
        }
        return table;
    }();
    uint32_t crc = ~0u;
    for (const uint8_t byte : bytes) crc = kTable[(crc ^ byte) & 0xFF] ^ crc >> 8;
    return ~crc;
}

}  // namespace

void seal(AtomicFile& file) {
    Bytes head = head_of(file);
    std::vector<uint64_t> places;
    each_place(head, kUnsealed, [&](auto at) { places.push_back(uint64_t(at - head.begin())); });
    if (places.empty()) return;
    const std::string filled = seal_of(head, file);
    for (const uint64_t place : places)
        file.write({reinterpret_cast<const uint8_t*>(filled.data()), filled.size()}, place);
}

bool is_as_written(const std::filesystem::path& path, const std::string& sealed) {
    const InputFile file(path);
    Bytes head = head_of(file);
    const size_t start = std::min(head.size(), kPictureKindBytes);
    if (picture_kind({reinterpret_cast<const char*>(head.data()), start}) == "png")
        return is_whole_png(read_file(path).bytes, true);
    const std::string_view unsealed = kUnsealed;
    if (sealed.size() != unsealed.size()) return false;
    each_place(head, sealed, [&](auto at) { std::copy(unsealed.begin(), unsealed.end(), at); });
    return seal_of(head, file) == sealed;
}

bool is_whole_png(std::span<const uint8_t> bytes, bool with_sums) {
    constexpr size_t kSignature = 8, kAroundData = 12;  // length, type, CRC
    const auto number = [&](size_t at) {
        return uint32_t(bytes[at]) << 24 | uint32_t(bytes[at + 1]) << 16 |
               uint32_t(bytes[at + 2]) << 8 | uint32_t(bytes[at + 3]);
    };
    for (size_t at = kSignature; at + kAroundData <= bytes.size();) {
        const size_t length = number(at);
        if (length > bytes.size() - at - kAroundData) return false;
        if (with_sums && crc32(bytes.subspan(at + 4, length + 4)) != number(at + 8 + length))
            return false;
        const bool last = std::equal(&bytes[at + 4], &bytes[at + 8], "IEND");
        at += length + kAroundData;
        if (last) return !with_sums || at == bytes.size();
    }
    return false;
}

}  // namespace petzval::io
