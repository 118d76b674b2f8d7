// SPDX-License-Identifier: Apache-2.0
// Exact sum: floats added in fixed point, so that any order and any grouping of the same numbers
// gives the same bits.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace petzval {

__extension__ typedef __int128 int128;

/// Sum of floats, each of which is rounded once to a multiple of 2^-fraction_bits: 128 bits in
/// two's complement. Integers add associatively (as in Kulisch 1971's long accumulator, which is as
/// long as all floats need; this one is as long as light does).
template <int fraction_bits>
class ExactSum {
  public:
    /// Numbers below it in magnitude may be added: 2^32 of them, as many as there are sample
    /// indices, stay within 127 bits.
    static constexpr float kLimit = static_cast<float>(int64_t(1) << (127 - 32 - fraction_bits));

    /// Adds a number of magnitude below kLimit; halves of a unit are rounded away from zero.
    void add(float value) {
        constexpr int kMantissaBits = 23, kExponentBias = 127;
        const uint32_t bits = std::bit_cast<uint32_t>(value);
        const int exponent = static_cast<int>(bits >> kMantissaBits & 0xFF);
        // Subnormal numbers round to nothing, like all that are below half a unit.
        const int64_t mantissa = (bits & 0x7FFFFF) | 0x800000;
        const int shift = exponent - kExponentBias - kMantissaBits + fraction_bits;
        int128 magnitude;
        if (shift >= 0)
            magnitude = int128(mantissa) << shift;
        else if (shift >= -kMantissaBits - 1)
            magnitude = (mantissa + (int64_t(1) << (-shift - 1))) >> -shift;
        else
            return;
        units_ += bits >> 31 ? -magnitude : magnitude;
    }
    ExactSum& operator+=(const ExactSum& other) {
        units_ += other.units_;
        return *this;
    }
    /// The sum, rounded to a double.
    [[nodiscard]] double value() const {
        constexpr double kUnit = 1.0 / static_cast<double>(int128(1) << fraction_bits);
        return static_cast<double>(units_) * kUnit;
    }
    bool operator==(const ExactSum&) const = default;

  private:
    int128 units_ = 0;
};

/// Sum of nits, of metres, of shares and of all else that is neither much smaller nor much larger
/// than they are: to 3.6e-15, up to 1.4e14. A moonless night has 1e-4 nits, the sun's disc 1.6e9.
using FilmSum = ExactSum<48>;
/// Sum of spectral radiances in W/(m2 sr nm): a nit of daylight has about 1e-5 of them.
using SpectralSum = ExactSum<64>;

/// Sum of squares of nits: to 5.8e-11, up to 2.3e18.
using SquareSum = ExactSum<34>;

static_assert(std::endian::native == std::endian::little, "packed sums are little-endian");

/// Writes sums as 16 bytes each, little-endian; returns where the next ones go.
template <int fraction_bits>
uint8_t* pack(std::span<const ExactSum<fraction_bits>> sums, uint8_t* to) {
    // An empty span has no address, and memcpy takes none.
    if (!sums.empty()) std::memcpy(to, sums.data(), sums.size_bytes());
    return to + sums.size_bytes();
}
/// Adds sums that pack() wrote; returns where the next ones are.
template <int fraction_bits>
const uint8_t* add_packed(std::span<ExactSum<fraction_bits>> sums, const uint8_t* from) {
    for (ExactSum<fraction_bits>& sum : sums) {
        ExactSum<fraction_bits> other;
        std::memcpy(&other, from, sizeof other);
        sum += other;
        from += sizeof other;
    }
    return from;
}

}  // namespace petzval
