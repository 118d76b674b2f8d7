// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_choice.h"

namespace petzval {

LightTree::OutsideShare LightChoice::share_at(const LightReceiver& r) const {
    return {shares_.factor(r.p), least_share_};
}

std::optional<LightChoice::Pick> LightChoice::pick(float u, const LightReceiver& receiver) const {
    float probability = 1.f;
    if (tree_) {
        const auto pick = tree_->pick(u, receiver, share_at(receiver));
        if (!pick) return std::nullopt;
        if (pick->light != LightTree::kOutside)
            return Pick{pick->light, pick->probability, pick->u};
        u = pick->u;
        probability = pick->probability;
    }
    if (choice_.size() == 0) return std::nullopt;
    const Piecewise1D::Draw drawn = choice_.sample(u);
    return Pick{drawn.cell, probability * drawn.probability, drawn.offset};
}

float LightChoice::probability(uint32_t light, const LightReceiver& receiver) const {
    const float among = choice_.size() == 0 ? 0.f : choice_.probability(light);
    if (!tree_) return among;
    const LightTree::OutsideShare share = share_at(receiver);
    return among > 0.f ? tree_->probability(LightTree::kOutside, receiver, share) * among
                       : tree_->probability(light, receiver, share);
}

}  // namespace petzval
