// SPDX-License-Identifier: Apache-2.0
// Where a node stands in its parent's space.
#pragma once

#include <array>
#include <nlohmann/json.hpp>

#include "core/math/math.h"

namespace petzval::io {

/// Place of a node in three parts.
struct NodePlace {
    std::array<double, 3> translation{0, 0, 0};
    std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion (x, y, z, w)
    std::array<double, 3> scale{1, 1, 1};

    /// Scaled, then turned, then moved; for row vectors.
    [[nodiscard]] M44d matrix() const;
};

/// The parts that the JSON of a node has, once it is checked.
[[nodiscard]] NodePlace stored_place(const nlohmann::json& node);
/// The node's matrix, else that of its parts.
[[nodiscard]] M44d stored_matrix(const nlohmann::json& node);

}  // namespace petzval::io
