// SPDX-License-Identifier: Apache-2.0
// Random numbers as a pure function of (seed, x, y, sample index, named dimension).
#pragma once

#include <utility>

#include "core/math/math.h"

namespace petzval {

/// Owen: Sobol points, nested uniform scrambling. Sobol: the same points, digits shifted only.
/// Independent: a hash. Every kind pads: each dimension has a shuffled 2-D sequence of its own.
/// Film and Lens have one of four dimensions together.
enum class SamplerKind { Owen, Sobol, Independent };

/// Named uses of random numbers, so that adding one leaves the others as they were.
enum class Dim : uint32_t {
    Film,
    Lens,
    Wavelength,
    Coverage,
    BsdfLobe,
    Bsdf,
    LightPoint,  ///< the light and the point on it together
    LightRest,   ///< what picking the light has used up of LightPoint
    Roulette,
    Count,
    // Apart from those of paths, so that pictures without targets keep their numbers.
    TargetPoint = 1u << 30,  ///< on a target's disc
    TargetPick,              ///< the target, and how it is reached
    TargetFilm,              ///< the film point from which it is seen
    TargetRest,              ///< whether a ray to a target brings more than what it finds
    Time,                    ///< while the shutter is open
    GhostPick,               ///< the two surfaces that reflect, and whether a ray is sent
    GhostPoint,              ///< on the last surface of the lens
    Diffraction,             ///< by how much a film point is displaced; 1: towards a lamp
    DiffractionPick          ///< the pattern and the wavelength that displace it; 1: the lamp
};

struct SampleId {
    int32_t x, y;    ///< pixel of the full frame, whatever the crop
    uint32_t index;  ///< 0 is the first sample; a shorter render is a prefix of a longer one
};

/// The word with its bits in reverse order.
[[nodiscard]] constexpr uint32_t reverse_bits(uint32_t a) {
    a = __builtin_bswap32(a);
    a = ((a >> 4) & 0x0f0f0f0fu) | ((a & 0x0f0f0f0fu) << 4);
    a = ((a >> 2) & 0x33333333u) | ((a & 0x33333333u) << 2);
    return ((a >> 1) & 0x55555555u) | ((a & 0x55555555u) << 1);
}

class Sampler {
  public:
    Sampler() = default;  ///< takes the place of one that is to come
    Sampler(SamplerKind kind, uint32_t seed, SampleId id)
        : kind_(kind),
          key_(hash32(hash32(hash32(static_cast<uint32_t>(id.x)) +
                             0x9e3779b9u * static_cast<uint32_t>(id.y)),
                      seed)),
          index_(id.index),
          reversed_(reverse_bits(id.index)) {}

    /// Sampler of one of `count` uses of the same numbers by this sample: all samples' uses
    /// together are stratified as samples are.
    [[nodiscard]] Sampler branch(uint32_t count, uint32_t number) const {
        Sampler out = *this;
        out.index_ = index_ * count + number;
        out.reversed_ = reverse_bits(out.index_);
        return out;
    }
    /// A number in [0, 1) for the named use at a path vertex (0: the camera).
    [[nodiscard]] float get1(Dim dim, uint32_t vertex = 0) const;
    /// A point of [0, 1)^2, stratified in both coordinates together.
    [[nodiscard]] V2f get2(Dim dim, uint32_t vertex = 0) const;
    /// Numbers for a path vertex in one call: those that get1 and get2 give for BsdfLobe, Bsdf,
    /// LightPoint and LightRest at this vertex, and for Roulette at the next.
    struct VertexNumbers {
        float bsdf_lobe, light_rest, roulette_after;
        V2f bsdf, light_point;
    };
    [[nodiscard]] VertexNumbers at_vertex(uint32_t vertex) const;
    /// 32 random bits for decisions that are taken out of order (coverage of BLEND surfaces).
    [[nodiscard]] uint32_t get_bits(Dim dim, uint32_t vertex = 0) const;

  private:
    [[nodiscard]] uint32_t dimension_key(Dim dim, uint32_t vertex) const;
    /// Both coordinates of a point for a dimension's key; Word may be several keys side by side.
    template <class Word>
    [[nodiscard]] std::pair<Word, Word> bits(Word key) const;
    /// Likewise, of the point of the lens, which belongs to that of the film.
    [[nodiscard]] std::pair<uint32_t, uint32_t> lens_bits() const;
    template <class Word>
    [[nodiscard]] Word shuffled_index(Word key) const;
    template <class Word>
    [[nodiscard]] std::pair<Word, Word> scrambled(Word x, Word y, Word key) const;

    SamplerKind kind_ = SamplerKind::Owen;
    uint32_t key_ = 0, index_ = 0, reversed_ = 0;  ///< reversed_: index_, lowest bit first
};

/// First two dimensions of Sobol's sequence (Sobol 1967), 32 bits: the radical inverse in base 2,
/// and Pascal's triangle modulo 2.
[[nodiscard]] uint32_t sobol_0(uint32_t index);
[[nodiscard]] uint32_t sobol_1(uint32_t index);

}  // namespace petzval
