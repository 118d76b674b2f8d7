// SPDX-License-Identifier: Apache-2.0
// The shutter of a camera: how long light gets in, and where the camera stands meanwhile.
#pragma once

#include <span>
#include <vector>

#include "core/math/ray.h"

namespace petzval::camera {

/// Openness of a shutter over time, straight between points. Times rise from 0 to 1; openness is
/// not negative, and above 0 somewhere.
struct ShutterCurve {
    struct Point {
        float time, open;
    };
    std::vector<Point> points;

    /// Opens and closes at once.
    [[nodiscard]] static ShutterCurve box() { return {{{0, 1}, {1, 1}}}; }
    /// Opens in the first quarter of the time and closes in the last one.
    [[nodiscard]] static ShutterCurve trapezoid() {
        return {{{0, 0}, {0.25f, 1}, {0.75f, 1}, {1, 0}}};
    }
    /// Area below the curve over its peak: the share of the time that a shutter which opens and
    /// closes at once would need for the same light (effective exposure time: ISO 516:2019).
    [[nodiscard]] float efficiency() const;
};

class Shutter {
  public:
    /// to_world: rigid places of the camera at two steps at least, evenly from time 0 to 1; none:
    /// it stands still. in_the_middle: the place that the camera's own rays start from.
    Shutter(ShutterCurve curve, std::span<const M44f> to_world, const M44f& in_the_middle);

    /// Time that is drawn in proportion to the openness; u in [0, 1).
    [[nodiscard]] float time(float u) const;
    /// Moves a camera ray to where the camera stands at the ray's time.
    void move(Ray&) const;
    /// Point of the world, at a time, in the place that it has for the camera at mid-exposure: a
    /// camera that stands still there sees this place as the moving one sees the point.
    [[nodiscard]] V3d seen_from_middle(const V3f& p, float time) const;

  private:
    [[nodiscard]] M44d moved(float time) const;

    ShutterCurve curve_;
    std::vector<float> reached_;     ///< share of the light up to each point of the curve
    std::vector<M44d> from_middle_;  ///< moves of the camera, at each step
};

}  // namespace petzval::camera
