// SPDX-License-Identifier: Apache-2.0
// Eight neighbouring texels of a picture that is sampled by importance, in one cache line.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/math/lanes.h"

namespace petzval {

/// Eight texels. Colours are half floats times a power of two: exact for what Radiance pictures
/// hold. The block splits an integer sampling weight, its share, over its texels, so that each is
/// drawn exactly as often as it says. The share itself is stored by the caller (Sky), not here.
class alignas(64) TexelBlock {
  public:
    static constexpr int kSize = 8;

    TexelBlock() = default;
    /// Texels: RGB, finite, not negative, at most eight; lane 3 is ignored.
    explicit TexelBlock(std::span<const f4> texels);
    /// Divides the share in proportion to the texels' weights, which are finite and not negative:
    /// none where a weight is 0, and not less than a unit or 2^-15 of all where it is above. share:
    /// at least a unit for each weight above 0, below 2^31.
    void divide(const std::array<float, kSize>& weights, uint32_t share);

    /// RGB in lanes 0 to 2; lane 3 means nothing.
    [[nodiscard]] f4 colour(int texel) const {
        __m128i halves;  // four: the fourth belongs to the next texel
        std::memcpy(&halves, reinterpret_cast<const char*>(this) + sizeof(rgb_[0]) * texel, 8);
        return _mm_cvtph_ps(halves) * std::bit_cast<float>((exponent_ + 127) << 23);
    }
    /// Number of units before a texel, 0 to 8.
    [[nodiscard]] uint32_t begin(int texel, uint32_t share) const {
        if (texel == 0) return 0;
        return texel < kSize ? start(texel, share) : share;
    }
    [[nodiscard]] uint32_t units(int texel, uint32_t share) const {
        return begin(texel + 1, share) - begin(texel, share);
    }
    /// The texel that has a unit, unit < share.
    [[nodiscard]] int find(uint32_t unit, uint32_t share) const {
        int texel = 0;
        for (int i = 1; i < kSize; ++i) texel += start(i, share) <= unit;
        return texel;
    }

  private:
    // A share of more than 15 bits is divided in steps of a power of two.
    [[nodiscard]] static int shift(uint32_t share) {
        return std::max(static_cast<int>(std::bit_width(share)), 15) - 15;
    }
    [[nodiscard]] uint32_t start(int texel, uint32_t share) const {
        return std::min(static_cast<uint32_t>(start_[texel - 1]) << shift(share), share);
    }

    std::array<std::array<uint16_t, 3>, kSize> rgb_{};
    std::array<uint16_t, kSize - 1> start_{};  ///< begin of the second to the last texel, in steps
    int16_t exponent_ = 0;
};
static_assert(sizeof(TexelBlock) == 64);

}  // namespace petzval
