// SPDX-License-Identifier: Apache-2.0
// Pose: where a camera stands, and how it is turned.
#pragma once

#include "core/math/math.h"

namespace petzval::camera {

/// Position of a camera and its axes in world space, unit, as its matrix says. It looks along -z.
struct Pose {
    V3f origin, right, up, back;

    explicit Pose(const M44f& m)
        : origin(m[3][0], m[3][1], m[3][2]),
          right(unit({m[0][0], m[0][1], m[0][2]})),
          up(unit({m[1][0], m[1][1], m[1][2]})),
          back(unit({m[2][0], m[2][1], m[2][2]})) {}
    /// Vector of the camera's space in the world, and the other way round.
    [[nodiscard]] V3f to_world(const V3f& v) const { return right * v.x + up * v.y + back * v.z; }
    [[nodiscard]] V3d local(const V3f& v) const {
        return {double(v.dot(right)), double(v.dot(up)), double(v.dot(back))};
    }
};

}  // namespace petzval::camera
