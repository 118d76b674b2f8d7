// SPDX-License-Identifier: Apache-2.0
// Which light to sample at a path vertex.
#pragma once

#include <optional>

#include "core/distribution.h"
#include "core/scene.h"

namespace petzval {

/// Power: in proportion to light_power. Uniform: the same for every light that has power.
enum class LightChoiceKind { Power, Uniform };

class LightChoice {
  public:
    /// The scene must be finished. Every light that has power gets a probability above 0, up to
    /// 2^23 lights.
    LightChoice(const Scene&, LightChoiceKind);

    struct Pick {
        uint32_t light;  ///< index into the scene's lights
        float probability;
    };
    /// u in [0, 1). Nothing where the scene has no light.
    [[nodiscard]] std::optional<Pick> pick(float u) const;
    /// Of picking the light; 0 for one without power.
    [[nodiscard]] float probability(uint32_t light) const;

  private:
    Piecewise1D choice_;
};

}  // namespace petzval
