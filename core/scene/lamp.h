// SPDX-License-Identifier: Apache-2.0
// Lamps that have a size: balls that shine, for lights of KHR_lights_punctual with a radius.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/beam.h"
#include "core/scene/scene.h"

namespace petzval {

/// A ball that sends the same light in all directions, or a beam. It reflects nothing.
struct BallLamp {
    V3f centre;
    float radius_m;
    Rgb intensity_cd;  ///< in all directions; of a beam: along its axis
    int32_t illuminant = -1;
    std::optional<Beam> beam{};  ///< the same from every point of the ball
    /// Centres at time steps while the shutter is open (core/scene/motion.h); empty: it is still.
    std::vector<V3f> centres{};
};

/// Adds lamps to a scene that is not finished, each as a mesh with a material of its own: a
/// geodesic sphere of 1280 triangles, of fewer where there are more than 800 lamps. Its area is
/// made up for, so that the mean intensity over all directions is exact; in single directions it is
/// within 0.1 % of it for 1280 triangles.
void add_lamps(Scene&, std::span<const BallLamp>);

}  // namespace petzval
