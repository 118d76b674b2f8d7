// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/meshopt_attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace petzval::io {
namespace {

// The numbers are those of the extension's appendix A. Four neighbouring bytes of an element are a
// channel: their differences from the element before are of one kind.
constexpr uint64_t kBlockBytes = 8192, kBlockElements = 256, kAttributeTail = 24, kChannel = 4;
constexpr uint8_t kHeader = 0xa1;

/// One byte of each element of a block, rounded up to whole groups.
using Deltas = std::array<uint8_t, kBlockElements>;

/// Bytes of the first element and of the kinds of its channels, with the zeros before them.
uint64_t tail_bytes(uint64_t stride) {
    return std::max(stride + stride / kChannel, kAttributeTail);
}

/// The bytes of a stream, one part after the other.
class Reader {
  public:
    explicit Reader(std::span<const uint8_t> bytes) : left_(bytes) {}

    /// The next bytes; null where there are fewer.
    const uint8_t* take(size_t count) {
        if (count > left_.size()) return nullptr;
        const uint8_t* const first = left_.data();
        left_ = left_.subspan(count);
        return first;
    }

    [[nodiscard]] bool at_end() const { return left_.empty(); }

  private:
    std::span<const uint8_t> left_;
};

/// Reads the deltas of a group, of 0, 1, 2, 4 or 8 bits each. Below 8 bits, one whose bits are all
/// set stands for a byte behind the group.
bool read_group(Reader& in, unsigned bits, uint8_t* deltas) {
    const uint8_t* const packed = in.take(kMeshoptGroup * bits / 8);
    if (!packed) return false;
    if (bits == 0 || bits == 8) {
        bits == 0 ? std::fill_n(deltas, kMeshoptGroup, uint8_t(0))
                  : std::copy_n(packed, kMeshoptGroup, deltas);
        return true;
    }
    const unsigned all_set = (1u << bits) - 1, in_a_byte = 8 / bits;
    for (unsigned i = 0; i < kMeshoptGroup; ++i) {
        const unsigned place = i % in_a_byte;  // single bits begin with the lowest, others do not
        const unsigned shift = bits * (bits == 1 ? place : in_a_byte - 1 - place);
        const unsigned delta = packed[i / in_a_byte] >> shift & all_set;
        const uint8_t* const byte = delta == all_set ? in.take(1) : nullptr;
        if (delta == all_set && !byte) return false;
        deltas[i] = byte ? *byte : uint8_t(delta);
    }
    return true;
}

/// Reads one byte of `count` elements, as its two bits of the block's header say.
bool read_deltas(Reader& in, unsigned control, size_t count, Deltas& deltas) {
    constexpr unsigned kZeros = 2, kLiteral = 3;
    constexpr unsigned kBits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    if (control == kZeros) {
        deltas.fill(0);
        return true;
    }
    if (control == kLiteral) {
        const uint8_t* const bytes = in.take(count);
        if (bytes) std::copy_n(bytes, count, deltas.begin());
        return bytes != nullptr;
    }
    const size_t groups = (count + kMeshoptGroup - 1) / kMeshoptGroup;
    const uint8_t* const header = in.take((groups + 3) / 4);
    for (size_t g = 0; header && g < groups; ++g)
        if (!read_group(in, kBits[control][header[g / 4] >> g % 4 * 2 & 3],
                        &deltas[g * kMeshoptGroup]))
            return false;
    return header != nullptr;
}

/// Adds differences to the numbers of type T that four bytes hold. The lowest bit of a difference
/// says that all others are inverted.
template <class T>
uint32_t add(uint32_t last, uint32_t deltas) {
    uint32_t sum = 0;
    for (unsigned shift = 0; shift < 32; shift += 8 * sizeof(T)) {
        const T delta = T(deltas >> shift);
        const T step = T((delta >> 1) ^ -(delta & 1));
        sum |= uint32_t(T(T(last >> shift) + step)) << shift;
    }
    return sum;
}

/// Kinds of channels, in the low four bits of their byte; the high four bits turn exclusive ors.
enum Kind : uint8_t { Bytes, Shorts, Xor };

bool is_kind(uint8_t channel) {
    return (channel & 15) == Xor || channel < Xor;
}

uint32_t following(uint32_t last, uint32_t deltas, uint8_t channel) {
    if (channel == Bytes) return add<uint8_t>(last, deltas);
    if (channel == Shorts) return add<uint16_t>(last, deltas);
    return last ^ std::rotr(deltas, channel >> 4);
}

/// Reads one channel of `count` elements, whose control bits are those of a byte, and writes it to
/// every `stride`-th byte of `out`. `last` is its value in the element before.
bool read_channel(Reader& in, uint8_t controls, uint8_t channel, size_t count, uint64_t stride,
                  uint32_t& last, uint8_t* out) {
    std::array<Deltas, kChannel> deltas;
    for (unsigned b = 0; b < kChannel; ++b)
        if (!read_deltas(in, controls >> 2 * b & 3, count, deltas[b])) return false;
    for (size_t i = 0; i < count; ++i) {
        uint32_t joined = 0;
        for (unsigned b = 0; b < kChannel; ++b) joined |= uint32_t(deltas[b][i]) << 8 * b;
        last = following(last, joined, channel);
        std::memcpy(out + i * stride, &last, sizeof last);
    }
    return true;
}

}  // namespace

uint64_t attributes_in_block(uint64_t stride) {
    return std::min(kBlockBytes / stride / kMeshoptGroup * kMeshoptGroup, kBlockElements);
}

uint64_t least_attribute_bytes_1(uint64_t count, uint64_t stride) {
    const uint64_t block = attributes_in_block(stride);
    return 1 + (count + block - 1) / block * (stride / kChannel) + tail_bytes(stride);
}

bool decode_attributes_1(std::span<const uint8_t> stream, uint64_t stride, std::span<uint8_t> out) {
    const uint64_t tail = tail_bytes(stride), channels = stride / kChannel;
    if (stream.size() < 1 + tail || stream[0] != kHeader) return false;
    const auto kinds = stream.last(channels);
    if (!std::all_of(kinds.begin(), kinds.end(), is_kind)) return false;
    std::array<uint32_t, 256 / kChannel> last{};
    std::memcpy(last.data(), stream.last(stride + channels).data(), stride);

    Reader in(stream.subspan(1, stream.size() - 1 - tail));
    const uint64_t count = out.size() / stride, block = attributes_in_block(stride);
    for (uint64_t first = 0; first < count; first += block) {
        const uint64_t elements = std::min(block, count - first);
        const uint8_t* const controls = in.take(channels);
        for (uint64_t c = 0; c < channels; ++c)
            if (!controls || !read_channel(in, controls[c], kinds[c], elements, stride, last[c],
                                           &out[first * stride + c * kChannel]))
                return false;
    }
    return in.at_end();
}

}  // namespace petzval::io
