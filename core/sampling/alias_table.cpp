// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/alias_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

AliasTable::AliasTable(std::span<const float> weights) : slots_(weights.size()) {
    const double mean =
        std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
    std::vector<double> left(weights.size());
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < weights.size(); ++i) {
        left[i] = static_cast<double>(weights[i]) / mean;
        (left[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t i = small.back(), giver = large.back();
        small.pop_back();
        slots_[i] = {static_cast<float>(left[i]), giver};
        left[giver] -= 1 - left[i];
        if (left[giver] < 1) {
            large.pop_back();
            small.push_back(giver);
        }
    }
    // Slots that rounding leaves over are full.
    for (const uint32_t i : large) slots_[i] = {1, i};
    for (const uint32_t i : small) slots_[i] = {1, i};
}

AliasTable::Draw AliasTable::sample(float u) const {
    const auto count = static_cast<double>(slots_.size());
    const double at = static_cast<double>(u) * count;
    const double slot = std::min(std::floor(at), count - 1);
    const auto i = static_cast<uint32_t>(slot);
    const auto within = static_cast<float>(at - slot);
    const auto [own, other] = slots_[i];
    constexpr float below_1 = 0x1.fffffep-1f;
    if (within < own) return {i, std::min(within / own, below_1)};
    return {other, std::min((within - own) / (1 - own), below_1)};
}

}  // namespace petzval
