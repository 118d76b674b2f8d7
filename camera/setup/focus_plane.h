// SPDX-License-Identifier: Apache-2.0
// Plane of the scene that a camera is focused on.
#pragma once

#include <optional>

#include "core/math/ray.h"

namespace petzval::camera {

/// Plane of focus in world space, metres. axis: unit, the camera's viewing direction.
struct FocusPlane {
    static constexpr float kFar_m = 1e6f;

    V3f eye, axis;
    float distance_m;  ///< along the axis; infinite: a plane so far away that directions decide

    /// Point at which a ray meets the plane; nothing where it leads backwards, as a fisheye's may.
    [[nodiscard]] std::optional<V3f> at(const Ray& ray) const {
        const float forward = ray.direction.dot(axis);
        if (!(forward > 0)) return std::nullopt;
        const float m = distance_m < kFar_m ? distance_m : kFar_m;
        const float t = (m - (ray.origin - eye).dot(axis)) / forward;
        return ray.origin + t * ray.direction;
    }
};

}  // namespace petzval::camera
