// SPDX-License-Identifier: Apache-2.0
// Lamps that have a size: balls and flat lamps that shine, as glTF's lights are with a size.
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
    bool unseen = false;  ///< camera rays do not meet it
};

/// A rectangle, or an ellipse in it, that shines from its front alone: in proportion to the cosine,
/// as a matt surface does, or a beam. It reflects nothing.
struct FlatLamp {
    /// Rigid: the lamp lies about the origin, width along x, height along y, and shines along -z.
    M44f to_world;
    V2f size_m;  ///< width and height
    bool ellipse = false;
    Rgb intensity_cd;  ///< along its axis, from afar
    int32_t illuminant = -1;
    std::optional<Beam> beam{};
    bool unseen = false;
    /// Matrices at time steps while the shutter is open; empty: it is still.
    std::vector<M44f> steps{};
};

/// Adds lamps to a scene that is not finished, each as a mesh with a material of its own: a
/// geodesic sphere of 1280 triangles, of fewer where there are more than 800 lamps. Its area is
/// made up for, so that the mean intensity over all directions is exact; in single directions it is
/// within 0.1 % of it for 1280 triangles.
void add_lamps(Scene&, std::span<const BallLamp>);
/// Adds flat lamps likewise. An ellipse is a polygon of 64 corners and of the ellipse's area.
void add_lamps(Scene&, std::span<const FlatLamp>);

}  // namespace petzval
