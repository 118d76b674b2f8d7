// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/spectrum_table.h"

#include <algorithm>

namespace petzval {

float SpectrumTable::at(float nm) const {
    const float place = std::clamp(nm - kFirst_nm, 0.f, float(kSpectrumSize - 1));
    const int i = std::min(static_cast<int>(place), kSpectrumSize - 2);
    const float t = place - static_cast<float>(i);
    const auto at = value.begin() + i;
    return at[0] * (1.f - t) + at[1] * t;
}

SpectrumTable tabulate(std::span<const std::pair<float, float>> points, Extrapolate beyond) {
    SpectrumTable table;
    const auto later = [](float nm, const auto& point) { return nm < point.first; };
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
        const auto wanted = static_cast<float>(nm);
        const auto next = std::upper_bound(points.begin(), points.end(), wanted, later);
        float& value = table.at_nm(nm);
        if (next == points.begin()) {
            value = beyond == Extrapolate::Hold ? points.front().second : 0.f;
        } else if (next == points.end()) {
            const bool last = wanted == points.back().first;
            value = last || beyond == Extrapolate::Hold ? points.back().second : 0.f;
        } else {
            const auto& [nm0, value0] = next[-1];
            const float t = (wanted - nm0) / (next->first - nm0);
            value = value0 * (1.f - t) + next->second * t;
        }
    }
    return table;
}

double integral(const SpectrumTable& a) {
    double sum = -(double(a.value.front()) + a.value.back()) / 2;
    for (const float value : a.value) sum += value;
    return sum;
}

double integral_of_product(const SpectrumTable& a, const SpectrumTable& b) {
    double sum = 0;
    for (size_t i = 0; i + 1 < a.value.size(); ++i) {
        const double a0 = a.value[i], a1 = a.value[i + 1], b0 = b.value[i], b1 = b.value[i + 1];
        sum += (2 * (a0 * b0 + a1 * b1) + a0 * b1 + a1 * b0) / 6;
    }
    return sum;
}

}  // namespace petzval
