// SPDX-License-Identifier: Apache-2.0
// Ways to choose one of many lights, without the code that chooses.
#pragma once

#include <cstdint>

namespace petzval {

/// Probability of a light. Power: in proportion to light_power. Uniform: the same for every light
/// that has power. Tree: in proportion to what light could do at the receiver, by a LightTree over
/// the lights that have a position; sky and suns share its first choice by their illuminance,
/// times what a pilot has learned (LightShares), and are chosen among by power.
enum class LightChoiceKind : uint8_t { Power, Uniform, Tree };

}  // namespace petzval
