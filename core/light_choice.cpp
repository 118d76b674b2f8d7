// SPDX-License-Identifier: Apache-2.0
#include "core/light_choice.h"

#include <algorithm>
#include <limits>

namespace petzval {

LightChoice::LightChoice(const Scene& scene, LightChoiceKind kind) {
    std::vector<float> weights;
    weights.reserve(scene.lights.size());
    for (const Light& light : scene.lights) {
        // The sum of all must stay finite, however bright the file says a lamp is.
        const float most =
            std::numeric_limits<float>::max() / static_cast<float>(scene.lights.size());
        float power = light_power(scene, light);
        if (!(power <= most)) power = most;
        weights.push_back(kind == LightChoiceKind::Uniform && power > 0.f ? 1.f : power);
    }
    if (std::any_of(weights.begin(), weights.end(), [](float w) { return w > 0.f; }))
        choice_ = Piecewise1D(weights);
}

std::optional<LightChoice::Pick> LightChoice::pick(float u) const {
    if (choice_.size() == 0) return std::nullopt;
    const Piecewise1D::Draw drawn = choice_.sample(u);
    return Pick{drawn.cell, drawn.probability};
}

float LightChoice::probability(uint32_t light) const {
    return choice_.size() == 0 ? 0.f : choice_.probability(light);
}

}  // namespace petzval
