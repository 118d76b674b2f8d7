// SPDX-License-Identifier: Apache-2.0
// Choice of the light to sample at a path vertex.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/light/light_options.h"
#include "core/light/light_shares.h"
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
        float u;  ///< position within the light's share of u, [0, 1]
    };
    /// Picks a light; u in [0, 1). Nothing where the scene has no light, or no light that was drawn
    /// can reach the receiver.
    [[nodiscard]] std::optional<Pick> pick(float u, const LightReceiver&) const;
    /// Probability of picking a light; 0 for one without power, or that cannot reach the receiver.
    [[nodiscard]] float probability(uint32_t light, const LightReceiver&) const;

    /// Whether lights at infinity and lights that have a position share the choice, so that a pilot
    /// can teach it.
    [[nodiscard]] bool divides() const { return tree_ != nullptr && choice_.size() > 0; }
    /// The same choice with even shares for the pilot: both groups are picked equally often.
    [[nodiscard]] LightChoice for_pilot() const;
    /// The same choice, with what a pilot has found.
    [[nodiscard]] LightChoice fitted(std::span<const LightRecord>) const;
    /// Record of a light sample of a choice that divides(): the light, nullopt where none was
    /// picked, and what it brought.
    [[nodiscard]] LightRecord record(const std::optional<uint32_t>& light, const LightReceiver&,
                                     float found) const;

    [[nodiscard]] const LightShares& shares() const { return shares_; }

  private:
    void plant(const Scene&, std::span<float> power);

    Piecewise1D choice_;  ///< choice among all lights; with a tree, among those outside it
    std::shared_ptr<const LightTree> tree_;  ///< copies of a choice share it
    LightShares shares_;
    float least_share_ = 0;
    [[nodiscard]] LightTree::OutsideShare share_at(const LightReceiver&) const;
};

}  // namespace petzval
