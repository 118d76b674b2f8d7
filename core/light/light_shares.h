// SPDX-License-Identifier: Apache-2.0
// Shares of lights at infinity, learned by place: sky and suns against lights that have a position.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// Groups of lights that a choice divides between.
enum class LightGroup : uint8_t { Outside, Inside };

/// Result of one light sample of a pilot.
struct LightRecord {
    V3f p;             ///< of the receiver
    LightGroup group;  ///< that was picked
    float expected;    ///< of the group at the receiver, as if nothing stood before it; any unit
    float found;       ///< light that it brought to the camera ray, with shadows; any unit
};

/// Map of factors on the expected light from outside. A k-d tree cuts the records' places at their
/// medians, down to leaves of some hundred.
class LightShares {
  public:
    /// Without records: 1 everywhere.
    LightShares() = default;
    /// Factors by which expectations meet what was found: in each leaf the ratio of the groups'
    /// root mean squares, as least variance shares samples in proportion to them; drawn towards the
    /// leaf above where records are few.
    explicit LightShares(std::span<const LightRecord>);

    /// Factor on the expected light from outside at a point, above 0.
    [[nodiscard]] float factor(const V3f& p) const {
        size_t node = 1;
        for (int level = 0; level < levels_; ++level) {
            const Cut& cut = cuts_[node];
            node = 2 * node + (p[cut.axis] > cut.at);
        }
        return factors_[node - (size_t{1} << levels_)];
    }
    [[nodiscard]] int levels() const { return levels_; }
    /// Factors of the leaves, from left to right: what was learned.
    [[nodiscard]] std::span<const float> factors() const { return factors_; }

  private:
    struct Cut {
        int axis;
        float at;
    };
    /// Sums over the records of a group.
    struct Sums {
        double expected2 = 0, found2 = 0;
    };
    using Groups = std::array<Sums, 2>;
    void fill(std::span<LightRecord>, size_t node, int level, const Groups& above);

    int levels_ = 0;
    std::vector<Cut> cuts_;            ///< 1 is the root; the children of n are 2 n and 2 n + 1
    std::vector<float> factors_{1.f};  ///< of the leaves, from left to right
};

}  // namespace petzval
