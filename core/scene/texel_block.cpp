// SPDX-License-Identifier: Apache-2.0
#include "core/scene/texel_block.h"

#include <cmath>

namespace petzval {

TexelBlock::TexelBlock(std::span<const f4> texels) {
    float most = 0;
    for (const f4 texel : texels)
        for (int c = 0; c < 3; ++c) most = std::max(most, texel[c]);
    if (!(most > 0)) return;
    // The brightest number gets the largest exponent of a half float but one.
    exponent_ = static_cast<int16_t>(std::max(std::ilogb(most) - 14, -126));
    for (size_t i = 0; i < texels.size(); ++i) {
        f4 scaled;
        // Up to the last half float below 2^15: the largest of all must not round to infinity.
        for (int c = 0; c < 3; ++c)
            scaled[c] = std::min(std::ldexp(texels[i][c], -exponent_), 32752.f);
        const __m128i halves = _mm_cvtps_ph(scaled, _MM_FROUND_TO_NEAREST_INT);
        std::memcpy(rgb_[i].data(), &halves, sizeof(rgb_[i]));
    }
}

void TexelBlock::divide(const std::array<float, kSize>& weights, uint32_t share) {
    double total = 0, running = 0;
    for (const float w : weights) total += w;
    if (!(total > 0)) return;
    const uint32_t step = 1u << shift(share), steps = (share + step - 1) / step;
    std::array<uint32_t, kSize + 1> edge{};
    for (int i = 0; i < kSize; ++i) {
        running += weights[i];
        edge[i + 1] = std::max(static_cast<uint32_t>(steps * (running / total) + 0.5),
                               edge[i] + (weights[i] > 0));
    }
    edge[kSize] = steps;  // edges that were lifted above it come down
    for (int i = kSize - 1; i > 0; --i) {
        edge[i] = std::min(edge[i], edge[i + 1] - (weights[i] > 0));
        start_[i - 1] = static_cast<uint16_t>(edge[i]);
    }
}

}  // namespace petzval
