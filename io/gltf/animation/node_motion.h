// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/math/math.h"
#include "io/gltf/animation/clip.h"

namespace petzval {

/// Places and shapes of the nodes of a file at time steps that are spread evenly over the time that
/// the shutter is open: 129, fewer where that would take over a gigabyte.
class NodeMotion {
  public:
    /// Nothing moves.
    NodeMotion() = default;
    /// posed: the file's JSON, checked, as it is in the middle. to_world: of every node, likewise.
    NodeMotion(const nlohmann::json& posed, std::span<const GltfClip>, const AnimationChoice&,
               std::span<const M44d> to_world);

    /// Places of a node in the world at the steps; nullptr for one that stands still.
    [[nodiscard]] const std::vector<M44d>* places(int node) const;
    /// Weights of the morph targets of the mesh that a node shows; nullptr where they stay.
    [[nodiscard]] const std::vector<std::vector<double>>* weights(int node) const;
    [[nodiscard]] size_t steps() const { return steps_; }
    /// Whether some keys lie so close together that what moves between time steps is not seen.
    [[nodiscard]] bool keys_between_steps() const { return keys_between_steps_; }
    [[nodiscard]] bool empty() const { return places_.empty() && weights_.empty(); }

  private:
    size_t steps_ = 0;
    bool keys_between_steps_ = false;
    std::map<int, std::vector<M44d>> places_;
    std::map<int, std::vector<std::vector<double>>> weights_;
};

/// Choice of every n-th of the time steps.
struct Thinning {
    size_t stride = 1;
    /// Bound on how far a point is off between the chosen steps, but for NodeMotion's
    /// keys_between_steps().
    double off_m = 0;
    double size_m = 0;  ///< greatest extent of the points in the middle

    /// The finer of two, with the greater error.
    [[nodiscard]] Thinning operator|(const Thinning&) const;
};

/// The fewest steps, a power of two and one more, so that points which matrices move run straight
/// between them within a thousandth of their extent. steps: a power of two and one more.
[[nodiscard]] Thinning thin(std::span<const M44d> to_world, std::span<const V3d> points);
/// The same for sums of `sizes_m` that weights scale, of a body of that size.
[[nodiscard]] Thinning thin(std::span<const std::vector<double>> weights,
                            std::span<const double> sizes_m, double size_m);

}  // namespace petzval
