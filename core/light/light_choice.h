// SPDX-License-Identifier: Apache-2.0
// Choice of the light to sample at a path vertex.
#pragma once

#include <optional>

#include "core/light/light_options.h"
#include "core/light/light_tree.h"
#include "core/sampling/distribution.h"
#include "core/scene/scene.h"

namespace petzval {

class LightChoice {
  public:
    /// Builds the choice for a finished scene. Every light that has power gets a probability above
    /// 0, up to 2^23 lights.
    LightChoice(const Scene&, LightChoiceKind);

    struct Pick {
        uint32_t light;  ///< index into the scene's lights
        float probability;
    };
    /// Picks a light; u in [0, 1). Nothing where the scene has no light, or no light that was drawn
    /// can reach the receiver.
    [[nodiscard]] std::optional<Pick> pick(float u, const LightReceiver&) const;
    /// Probability of picking a light; 0 for one without power, or that cannot reach the receiver.
    [[nodiscard]] float probability(uint32_t light, const LightReceiver&) const;

  private:
    void plant(const Scene&, std::span<float> power);

    Piecewise1D choice_;  ///< choice among all lights; with a tree, among those outside it
    std::optional<LightTree> tree_;
};

}  // namespace petzval
