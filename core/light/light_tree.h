// SPDX-License-Identifier: Apache-2.0
// Light tree: a hierarchy over the lights that have a position, to choose those that matter at a
// point. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", without the splitting, and with eight children a node, which are weighed together.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/light/light_sample.h"
#include "core/math/lanes.h"
#include "core/math/math.h"

namespace petzval {

/// Bounds of the position and direction of a light or a cluster: every light of it lies in the box
/// and has its axis within `spread` of the axis; it shines up to `reach` away from its own.
struct LightBounds {
    Box3f box;
    V3f axis{0, 0, 1};            ///< unit
    float spread = 0, reach = 0;  ///< rad; spread up to pi, reach up to pi / 2
    bool two_sided = false;       ///< the opposite of an axis is an axis as well
    /// Power in lumen, up to a common factor; above 0 and finite, in a sum too.
    float power = 0;

    /// Bounds of both together.
    [[nodiscard]] LightBounds operator|(const LightBounds&) const;
};

class LightTree {
  public:
    /// Tree of the lights that have bounds. outside: illuminance, in the unit of the powers per
    /// square metre, of the lights at infinity, which share the choice.
    LightTree(std::span<const std::optional<LightBounds>> lights, float outside);

    static constexpr uint32_t kOutside = ~0u;
    /// Share of the lights at infinity at a receiver, as far as it is known.
    struct OutsideShare {
        float factor = 1;  ///< on their illuminance
        /// Probability that they have at least, and that they leave, where both kinds of light can
        /// reach the receiver; up to 1/2.
        float least = 0;
    };
    /// Illuminance, in a unit of their own, that the lights of the tree and those outside would
    /// bring if nothing stood in between.
    struct Strength {
        float inside, outside;
    };
    [[nodiscard]] Strength strength(const LightReceiver&) const;
    struct Pick {
        uint32_t light;  ///< index into the lights, or kOutside
        float probability;
        float u;  ///< position within the light's share of u, [0, 1): may be used again
    };
    /// Picks a light; u in [0, 1). Nothing where the lights that were drawn cannot reach the
    /// receiver.
    [[nodiscard]] std::optional<Pick> pick(float u, const LightReceiver&,
                                           const OutsideShare&) const;
    /// Probability of picking a light, or kOutside; 0 only for lights that cannot reach the
    /// receiver.
    [[nodiscard]] float probability(uint32_t light, const LightReceiver&,
                                    const OutsideShare&) const;

  private:
    struct Node {
        f8 x{}, y{}, z{}, radius{};  ///< sphere about each child
        f8 axis_x{}, axis_y{}, axis_z{};
        f8 cos_spread{}, sin_spread{}, cos_reach{};
        f8 intensity{};  ///< 0: no child
        m8 two_sided{};
        std::array<uint32_t, 8> child{};  ///< a light where is_light has the child's bit, or a node
        uint32_t is_light = 0;
    };
    struct Item {
        LightBounds bounds;
        uint32_t light;
    };
    void build(std::span<Item>, uint32_t node);
    [[nodiscard]] static std::size_t split(std::span<Item>);
    /// Weight of the lights outside beside a sum of weights of lights inside.
    [[nodiscard]] float outside_beside(float inside, const OutsideShare&) const;
    [[nodiscard]] static f8 weigh(const Node&, const LightReceiver&);

    std::vector<Node> nodes_;       ///< 0 is the root
    std::vector<uint32_t> parent_;  ///< slot of each node in its parent: 8 * node + child
    std::vector<uint32_t> place_;   ///< slot of each light, as parent_; kOutside: not in the tree
    float outside_ = 0;
};

}  // namespace petzval
