// SPDX-License-Identifier: Apache-2.0
#include "io/image/symmetric_mse.h"

namespace petzval {
namespace {

constexpr double kMidGrey = 0.18;
/// Shares of the pixels: what is brighter may be brighter than white, or is left out of what is
/// nearly the brightest.
constexpr double kMayClip = 0.1, kBrightest = 0.05;
constexpr double kDarkest = 0.01;  ///< of the nearly brightest

/// Value that a share of sorted values is above.
double above(const std::vector<double>& sorted, double share) {
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<size_t>(std::floor(last * (1 - share)))];
}

}  // namespace

Tone tone_of(std::vector<double> luminances) {
    std::erase_if(luminances, [](double l) { return !(l > 0); });
    if (luminances.empty()) return {};
    std::sort(luminances.begin(), luminances.end());
    const double least = kDarkest * above(luminances, kBrightest);
    double logs = 0;
    for (const double l : luminances) logs += std::log(std::max(l, least));
    const double average = std::exp(logs / static_cast<double>(luminances.size()));
    return {average, std::max(average, kMidGrey * above(luminances, kMayClip))};
}

}  // namespace petzval
