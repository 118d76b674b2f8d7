// SPDX-License-Identifier: Apache-2.0
// Film size: the part of a sensor that a picture uses, and the sensor that a lens is made for.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/math.h"

namespace petzval::camera {

/// The largest rectangle of an aspect (width / height) inside a sensor; width and height in mm.
[[nodiscard]] inline V2f film_within(V2f sensor_mm, float aspect) {
    return sensor_mm.x / sensor_mm.y > aspect ? V2f(sensor_mm.y * aspect, sensor_mm.y)
                                              : V2f(sensor_mm.x, sensor_mm.x / aspect);
}

/// The largest 3:2 rectangle inside a lens's image circle, at most 36 x 24 mm; width and height in
/// mm. image_circle_mm: its diameter; 0 where it is not known, which counts as full frame.
[[nodiscard]] inline V2f usual_sensor_mm(double image_circle_mm) {
    constexpr float kFullFrameCircle_mm = 43.27f;
    const float circle = image_circle_mm > 0 ? float(image_circle_mm) : kFullFrameCircle_mm;
    const float unit_mm = std::min(circle / std::sqrt(13.f), 12.f);  // of a 3 x 2 rectangle
    return {3 * unit_mm, 2 * unit_mm};
}

}  // namespace petzval::camera
