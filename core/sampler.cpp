// SPDX-License-Identifier: Apache-2.0
#include "core/sampler.h"

namespace petzval {
namespace {

// Nested uniform scrambling (Owen 1995) of a bit-reversed word: each bit is flipped by a hash of
// the bits below it. Laine and Karras 2011, with the constants of Vegdahl 2021, "Building a Better
// LK Hash".
uint32_t scramble_reversed(uint32_t a, uint32_t seed) {
    a ^= a * 0x3d20adeau;
    a += seed;
    a *= (seed >> 16) | 1u;
    a ^= a * 0x05526c56u;
    a ^= a * 0x53a22864u;
    return a;
}

// sobol_1 with the output bits reversed: row k of Pascal's triangle modulo 2 for each set bit k.
// By Lucas's theorem the matrix is a Kronecker power, so five masked shifts apply it.
uint32_t pascal_mod_2(uint32_t a) {
    a ^= (a & 0xaaaaaaaau) >> 1;
    a ^= (a & 0xccccccccu) >> 2;
    a ^= (a & 0xf0f0f0f0u) >> 4;
    a ^= (a & 0xff00ff00u) >> 8;
    return a ^ ((a & 0xffff0000u) >> 16);
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
V2f Sampler::get2(Dim dim, uint32_t vertex) const {
    const uint32_t key = dimension_key(dim, vertex);
    if (kind_ == SamplerKind::Independent) {
        const uint32_t first = hash32(key, index_);
        return {to_unit_float(first), to_unit_float(hash32(first + 0x68bc21ebu))};
    }
    const uint32_t index = reverse_bits(scramble_reversed(reversed_, key));
    const uint32_t key_x = hash32(key ^ 0x2c1b3c6du), key_y = hash32(key ^ 0x297a2d39u);
    if (kind_ == SamplerKind::Sobol)
        return {to_unit_float(sobol_0(index) ^ key_x), to_unit_float(sobol_1(index) ^ key_y)};
    return {to_unit_float(reverse_bits(scramble_reversed(index, key_x))),
            to_unit_float(reverse_bits(scramble_reversed(pascal_mod_2(index), key_y)))};
}

float Sampler::get1(Dim dim, uint32_t vertex) const {
    const uint32_t key = dimension_key(dim, vertex);
    if (kind_ == SamplerKind::Independent) return to_unit_float(hash32(key, index_));
    const uint32_t index = reverse_bits(scramble_reversed(reversed_, key));
    const uint32_t key_x = hash32(key ^ 0x2c1b3c6du);
    if (kind_ == SamplerKind::Sobol) return to_unit_float(sobol_0(index) ^ key_x);
    return to_unit_float(reverse_bits(scramble_reversed(index, key_x)));
}

uint32_t Sampler::get_bits(Dim dim, uint32_t vertex) const {
    return hash32(dimension_key(dim, vertex), index_);
}

}  // namespace petzval
