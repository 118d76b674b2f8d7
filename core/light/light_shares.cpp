// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_shares.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace petzval {
namespace {

constexpr size_t kLeaf = 128;     ///< records that a leaf has at least
constexpr double kFromAbove = 4;  ///< records that what is known from above counts for
constexpr float kLeast = 1e-30f, kMost = 1e30f;

int longest_side(std::span<const LightRecord> records) {
    Box3f box;
    for (const LightRecord& r : records) box.extendBy(r.p);
    const V3f size = box.size();
    return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

// Root of what was found over what was expected; nothing was expected where the group is absent.
double strength(double found2, double expected2) {
    return expected2 > 0 ? std::sqrt(found2 / expected2) : 0;
}

}  // namespace

LightShares::LightShares(std::span<const LightRecord> records) {
    // The film leaves out samples that are no numbers, and so does what is learned.
    std::vector<LightRecord> sorted;
    std::copy_if(records.begin(), records.end(), std::back_inserter(sorted),
                 [](const LightRecord& r) { return std::isfinite(r.found); });
    if (sorted.empty()) return;
    levels_ = std::max(static_cast<int>(std::bit_width(sorted.size() / kLeaf)) - 1, 0);
    cuts_.resize(size_t{1} << levels_);
    factors_.resize(size_t{1} << levels_);
    fill(sorted, 1, 0, {});
}

void LightShares::fill(std::span<LightRecord> records, size_t node, int level,
                       const Groups& above) {
    Groups sums{};
    std::array<double, 2> count{};
    for (const LightRecord& r : records) {
        const auto group = static_cast<size_t>(r.group);
        sums[group].expected2 += sqr(double(r.expected));
        sums[group].found2 += sqr(double(r.found));
        ++count[group];
    }
    // What is known from above counts as so many records that expected what those here do: a leaf
    // in the dark takes from it how much was found of what was expected, not how much light.
    for (size_t g = 0; g < 2 && level > 0; ++g) {
        if (count[g] == 0) {
            sums[g] = above[g];
            continue;
        }
        const double expected2 = kFromAbove * sums[g].expected2 / count[g];
        sums[g].expected2 += expected2;
        if (above[g].expected2 > 0)
            sums[g].found2 += expected2 * (above[g].found2 / above[g].expected2);
    }
    if (level == levels_) {
        const double outside = strength(sums[0].found2, sums[0].expected2);
        const double inside = strength(sums[1].found2, sums[1].expected2);
        const double factor = inside > 0 ? outside / inside : kMost;
        factors_[node - (size_t{1} << levels_)] =
            std::clamp(static_cast<float>(factor), kLeast, kMost);
        return;
    }
    const int axis = longest_side(records);
    const auto middle = records.begin() + static_cast<ptrdiff_t>(records.size() / 2);
    std::sort(records.begin(), records.end(),
              [axis](const LightRecord& a, const LightRecord& b) { return a.p[axis] < b.p[axis]; });
    cuts_[node] = {axis, middle->p[axis]};
    fill(records.first(records.size() / 2), 2 * node, level + 1, sums);
    fill(records.subspan(records.size() / 2), 2 * node + 1, level + 1, sums);
}

}  // namespace petzval
