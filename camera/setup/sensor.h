// SPDX-License-Identifier: Apache-2.0
// What of a sensor a picture uses.
#pragma once

#include "core/math/math.h"

namespace petzval {

/// The largest rectangle of an aspect (width / height) inside a sensor; width and height in mm.
[[nodiscard]] inline V2f film_within(V2f sensor_mm, float aspect) {
    return sensor_mm.x / sensor_mm.y > aspect ? V2f(sensor_mm.y * aspect, sensor_mm.y)
                                              : V2f(sensor_mm.x, sensor_mm.x / aspect);
}

}  // namespace petzval
