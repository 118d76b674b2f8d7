// SPDX-License-Identifier: Apache-2.0
// Seeds of what learns before the first sample.
#pragma once

#include <cstdint>

namespace petzval {

/// Seed of each prepass, so that none of its random numbers is one of the picture, nor of another
/// prepass.
enum class PrepassSeed : uint32_t {
    Plan = 2'000'000,  ///< the first of those that follow
    TargetCells = 0x63656c6c,
    Exposure = 0x65787073,
    Noise = 0x6e6f6973,
    Highlights = 0x676c696e,
    LightShares = 0x6c696768,
    Targets = 0x74617267
};

/// The seed as a number.
[[nodiscard]] constexpr uint32_t number_of(PrepassSeed seed) {
    return static_cast<uint32_t>(seed);
}

}  // namespace petzval
