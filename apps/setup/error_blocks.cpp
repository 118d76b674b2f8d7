// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/error_blocks.h"

#include <algorithm>
#include <cmath>

#include "apps/setup/student_t.h"

namespace petzval::apps {

double DenoisedError::least() const {
    return std::sqrt(std::max(0., squared - kDeviations * deviation));
}

double DenoisedError::most() const {
    return std::sqrt(std::max(0., squared + kDeviations * deviation));
}

double DenoisedError::value() const {
    return is_at_most() ? most() : std::sqrt(squared);
}

ErrorBlocks::ErrorBlocks(int width_px, int height_px)
    : across_((width_px + kErrorBlock_px - 1) / kErrorBlock_px),
      down_((height_px + kErrorBlock_px - 1) / kErrorBlock_px),
      sum_(static_cast<size_t>(across_) * static_cast<size_t>(down_)),
      count_(sum_.size()),
      variance_(sum_.size()),
      variance_squares_(sum_.size()),
      doubt_(sum_.size()) {}

void ErrorBlocks::add(int x, int y, double squared_error, double variance, double doubt) {
    const auto at = static_cast<size_t>(y / kErrorBlock_px * across_ + x / kErrorBlock_px);
    sum_[at] += squared_error;
    variance_[at] += variance;
    variance_squares_[at] += variance * variance;
    doubt_[at] += doubt;
    count_[at] += 1;
}

// Errors of neighbours are alike, as they share a window: two by two blocks are taken together.
DenoisedError ErrorBlocks::over(const Rect& r) const {
    double all = 0, pixels = 0;
    const auto each = [&](const auto& use) {
        for (int y = r.y0; y < r.y1; y += 2)
            for (int x = r.x0; x < r.x1; x += 2) {
                double s = 0, n = 0;
                for (int v = y; v < std::min(y + 2, r.y1); ++v)
                    for (int u = x; u < std::min(x + 2, r.x1); ++u) {
                        s += sum_[static_cast<size_t>(v * across_ + u)];
                        n += count_[static_cast<size_t>(v * across_ + u)];
                    }
                use(s, n);
            }
    };
    each([&](double s, double n) { all += s, pixels += n; });
    const double mean = all / pixels;
    double chance = 0;  // the product of two halves' noise, in a block
    double doubt = 0, doubt_by_chance = 0;
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            const auto at = static_cast<size_t>(y * across_ + x);
            doubt += doubt_[at];
            doubt_by_chance += doubt_[at] * doubt_[at];
            if (!(variance_[at] > 0)) continue;
            // Pixels that have the noise, by how even it is (Kish 1965); but no less than 4 x 4.
            constexpr double kLeastShare = 0.25;
            const double alike = variance_[at] * variance_[at] / variance_squares_[at];
            chance += variance_[at] * variance_[at] / std::max(alike, kLeastShare * count_[at]);
        }
    // What of it all blocks have in common: their own is in what they part by.
    doubt = std::max(0., doubt * doubt - doubt_by_chance) / (kDeviations * kDeviations);
    double squares = 0, groups = 0;
    each([&](double s, double n) {
        squares += (s - n * mean) * (s - n * mean);
        groups += 1;
    });
    if (groups < 2) return {mean, std::sqrt(std::max(all * all, chance) + doubt) / pixels};
    const double parted = squares * groups / (groups - 1);
    // Wider, as the deviation is known from few numbers; chance is from many pixels.
    const double widening = student_t_975(groups - 1) / kDeviations;
    return {mean, std::sqrt(std::max(widening * widening * parted, chance) + doubt) / pixels};
}

}  // namespace petzval::apps
