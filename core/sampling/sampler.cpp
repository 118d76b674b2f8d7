// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/sampler.h"

#include "core/math/lanes.h"

namespace petzval {
namespace {

u32x8 reverse_bits(u32x8 a) {
    typedef uint8_t u8x32 __attribute__((vector_size(32)));
    const u8x32 bytes = (u8x32)a;
    a = (u32x8)__builtin_shufflevector(bytes, bytes, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14,
                                       13, 12, 19, 18, 17, 16, 23, 22, 21, 20, 27, 26, 25, 24, 31,
                                       30, 29, 28);
    a = ((a >> 4) & 0x0f0f0f0fu) | ((a & 0x0f0f0f0fu) << 4);
    a = ((a >> 2) & 0x33333333u) | ((a & 0x33333333u) << 2);
    return ((a >> 1) & 0x55555555u) | ((a & 0x55555555u) << 1);
}

f8 to_unit_floats(u32x8 bits) {
    return __builtin_convertvector((m8)(bits >> 8), f8) * 0x1p-24f;
}

// Nested uniform scrambling (Owen 1995) of a bit-reversed word: each bit is flipped by a hash of
// the bits below it. Laine and Karras 2011, with the constants of Vegdahl 2021, "Building a Better
// LK Hash".
template <class Word>
Word scramble_reversed(Word a, Word seed) {
    a ^= a * 0x3d20adeau;
    a += seed;
    a *= (seed >> 16) | 1u;
    a ^= a * 0x05526c56u;
    a ^= a * 0x53a22864u;
    return a;
}

// sobol_1 with the output bits reversed: row k of Pascal's triangle modulo 2 for each set bit k.
// By Lucas's theorem the matrix is a Kronecker power, so five masked shifts apply it: one within
// the digits of base 4, four between them.
template <class Word>
Word pascal_in_digits(Word a) {
    return a ^ ((a & 0xaaaaaaaau) >> 1);
}
template <class Word>
Word pascal_of_digits(Word a) {
    a ^= (a & 0xccccccccu) >> 2;
    a ^= (a & 0xf0f0f0f0u) >> 4;
    a ^= (a & 0xff00ff00u) >> 8;
    return a ^ ((a & 0xffff0000u) >> 16);
}
template <class Word>
Word pascal_mod_2(Word a) {
    return pascal_of_digits(pascal_in_digits(a));
}

// Digits of base 4, each times a power of w, the root of w^2 = w + 1 in the field of four numbers:
// w to the number of the digit, and one over it.
struct Turned {
    uint32_t up, down;
};
Turned turned(uint32_t a) {
    constexpr uint32_t kLow = 0x55555555u, kDigits0 = 0xc30c30c3u, kDigits1 = 0x0c30c30cu,
                       kDigits2 = 0x30c30c30u;
    const uint32_t low = a & kLow, high = (a >> 1) & kLow, sum = low ^ high;
    const uint32_t once = sum | low << 1, twice = high | sum << 1, rest = a & kDigits0;
    return {rest | (once & kDigits1) | (twice & kDigits2),
            rest | (twice & kDigits1) | (once & kDigits2)};
}

}  // namespace

uint32_t sobol_0(uint32_t index) {
    return reverse_bits(index);
}

uint32_t sobol_1(uint32_t index) {
    return reverse_bits(pascal_mod_2(index));
}

uint32_t Sampler::dimension_key(Dim dim, uint32_t vertex) const {
    return hash32(key_ + vertex * static_cast<uint32_t>(Dim::Count) + static_cast<uint32_t>(dim));
}

// Padding as in Burley 2020, "Practical Hash-based Owen Scrambling": the index is shuffled by a
// scramble of its own in each dimension, which keeps every power-of-two block together.
template <class Word>
Word Sampler::shuffled_index(Word key) const {
    return reverse_bits(scramble_reversed(Word{} + reversed_, key));
}

template <class Word>
std::pair<Word, Word> Sampler::scrambled(Word x, Word y, Word key) const {
    const Word key_x = hash_words(key ^ 0x2c1b3c6du), key_y = hash_words(key ^ 0x297a2d39u);
    if (kind_ == SamplerKind::Sobol) return {reverse_bits(x) ^ key_x, reverse_bits(y) ^ key_y};
    return {reverse_bits(scramble_reversed(x, key_x)), reverse_bits(scramble_reversed(y, key_y))};
}

template <class Word>
std::pair<Word, Word> Sampler::bits(Word key) const {
    if (kind_ == SamplerKind::Independent) {
        const Word first = hash_words(key ^ hash32(index_ + 0x9e3779b9u));
        return {first, hash_words(first + 0x68bc21ebu)};
    }
    const Word index = shuffled_index(key);
    return scrambled(index, pascal_mod_2(index), key);
}

// Matrices of a (0, 4)-sequence in base 4: Pascal's triangle over the field of four numbers, with
// the powers of 0, 1, w and w^2 (Faure 1982; Niederreiter 1987, "Point sets and sequences with
// small discrepancy"). Sobol's two are the first two of them. What happens within a digit is free:
// here it makes the other two a (0, 2)-sequence in base 2 as well, as in Ahmed et al. 2025, "SZ
// Sequences".
std::pair<uint32_t, uint32_t> Sampler::lens_bits() const {
    const uint32_t key = dimension_key(Dim::Lens, 0);
    if (kind_ == SamplerKind::Independent) return bits(key);
    const Turned index = turned(shuffled_index(dimension_key(Dim::Film, 0)));
    return scrambled(pascal_in_digits(turned(pascal_of_digits(index.up)).down),
                     turned(pascal_of_digits(index.down)).up, key);
}

V2f Sampler::get2(Dim dim, uint32_t vertex) const {
    const auto [x, y] = dim == Dim::Lens ? lens_bits() : bits(dimension_key(dim, vertex));
    return {to_unit_float(x), to_unit_float(y)};
}

float Sampler::get1(Dim dim, uint32_t vertex) const {
    return to_unit_float(bits(dimension_key(dim, vertex)).first);
}

Sampler::VertexNumbers Sampler::at_vertex(uint32_t vertex) const {
    constexpr auto number = [](Dim dim) { return static_cast<uint32_t>(dim); };
    constexpr u32x8 dims{number(Dim::BsdfLobe), number(Dim::Bsdf), number(Dim::LightRest),
                         number(Dim::LightPoint), number(Dim::Count) + number(Dim::Roulette)};
    const auto [bits_x, bits_y] = bits(hash_words(dims + (key_ + vertex * number(Dim::Count))));
    const f8 x = to_unit_floats(bits_x), y = to_unit_floats(bits_y);
    return {x[0], x[2], x[4], {x[1], y[1]}, {x[3], y[3]}};
}

uint32_t Sampler::get_bits(Dim dim, uint32_t vertex) const {
    return hash32(dimension_key(dim, vertex), index_);
}

}  // namespace petzval
