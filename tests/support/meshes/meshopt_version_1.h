// SPDX-License-Identifier: Apache-2.0
// An encoder of meshopt attribute streams of version 1 that chooses at random, so that all that the
// format allows occurs; written from KHR_meshopt_compression, appendix A.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <vector>

namespace petzval::test {

class MeshoptVersion1 {
  public:
    using Bytes = std::vector<uint8_t>;

    /// kinds: of each four bytes of an element: 0 bytes, 1 shorts, 2 + 16 * turn exclusive ors.
    MeshoptVersion1(uint32_t seed, Bytes kinds) : random_(seed), kinds_(std::move(kinds)) {}

    [[nodiscard]] Bytes encode(std::span<const uint8_t> elements) {
        const size_t stride = 4 * kinds_.size(), count = elements.size() / stride;
        const size_t block = std::min<size_t>(8192 / stride & ~size_t(15), 256);
        Bytes out = {0xa1};
        for (size_t first = 0; first < count; first += block)
            append(out, encode_block(elements, first, std::min(block, count - first)));
        if (stride + kinds_.size() < 24) out.resize(out.size() + 24 - stride - kinds_.size());
        append(out, Bytes(elements.begin(), elements.begin() + ptrdiff_t(stride)));
        append(out, kinds_);
        return out;
    }

  private:
    static void append(Bytes& out, const Bytes& more) {
        out.insert(out.end(), more.begin(), more.end());
    }

    static uint32_t word(std::span<const uint8_t> elements, size_t at) {
        uint32_t value;
        std::memcpy(&value, &elements[at], sizeof value);
        return value;
    }

    template <class T>
    static uint32_t zigzag(uint32_t now, uint32_t last) {
        uint32_t out = 0;
        for (int shift = 0; shift < 32; shift += 8 * int(sizeof(T))) {
            const T v = T(T(now >> shift) - T(last >> shift));
            const bool negative = v >> (8 * sizeof(T) - 1);
            out |= uint32_t(T(negative ? ~(v << 1) : v << 1)) << shift;
        }
        return out;
    }

    static uint32_t delta(uint8_t kind, uint32_t now, uint32_t last) {
        if (kind == 0) return zigzag<uint8_t>(now, last);
        return kind == 1 ? zigzag<uint16_t>(now, last) : std::rotl(now ^ last, kind >> 4);
    }

    Bytes encode_block(std::span<const uint8_t> elements, size_t first, size_t count) {
        const size_t stride = 4 * kinds_.size();
        Bytes controls(kinds_.size()), data;
        for (size_t c = 0; c < kinds_.size(); ++c) {
            std::vector<Bytes> bytes(4, Bytes(count));
            for (size_t i = 0; i < count; ++i) {
                const size_t at = (first + i) * stride + 4 * c;
                const uint32_t last =
                    first + i == 0 ? word(elements, at) : word(elements, at - stride);
                const uint32_t d = delta(kinds_[c], word(elements, at), last);
                for (size_t b = 0; b < 4; ++b) bytes[b][i] = uint8_t(d >> 8 * b);
            }
            for (size_t b = 0; b < 4; ++b) {
                unsigned control = random_() % 4;
                if (control == 2 && !zeros(bytes[b])) control = 3;
                controls[c] = uint8_t(controls[c] | control << 2 * b);
                if (control == 3) append(data, bytes[b]);
                if (control < 2) append(data, encode_groups(control, bytes[b]));
            }
        }
        append(controls, data);
        return controls;
    }

    static bool zeros(std::span<const uint8_t> bytes) {
        return std::all_of(bytes.begin(), bytes.end(), [](uint8_t b) { return b == 0; });
    }

    Bytes encode_groups(unsigned control, Bytes bytes) {
        constexpr unsigned kBits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
        bytes.resize((bytes.size() + 15) / 16 * 16);
        const size_t groups = bytes.size() / 16;
        Bytes header((groups + 3) / 4), data;
        for (size_t g = 0; g < groups; ++g) {
            const auto group = std::span(bytes).subspan(16 * g, 16);
            unsigned mode = random_() % 4;
            if (kBits[control][mode] == 0 && !zeros(group)) mode = 1 + random_() % 3;
            header[g / 4] = uint8_t(header[g / 4] | mode << 2 * (g % 4));
            append(data, encode_group(kBits[control][mode], group));
        }
        append(header, data);
        return header;
    }

    static Bytes encode_group(unsigned bits, std::span<const uint8_t> group) {
        if (bits == 0) return {};
        if (bits == 8) return {group.begin(), group.end()};
        const unsigned sentinel = (1u << bits) - 1;
        Bytes packed, behind;
        unsigned byte = 0, filled = 0;
        for (const uint8_t d : group) {
            const unsigned value = std::min<unsigned>(d, sentinel);
            if (value == sentinel) behind.push_back(d);
            byte = bits == 1 ? byte | value << filled : byte << bits | value;
            filled += bits;
            if (filled < 8) continue;
            packed.push_back(uint8_t(byte));
            byte = filled = 0;
        }
        append(packed, behind);
        return packed;
    }

    std::mt19937 random_;
    Bytes kinds_;
};

}  // namespace petzval::test
