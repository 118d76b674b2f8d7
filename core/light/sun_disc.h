// SPDX-License-Identifier: Apache-2.0
// The disc of a sun that has a width: a cone of directions of even radiance.
#pragma once

#include "core/math/math.h"
#include "core/math/trig.h"
#include "core/scene/light.h"

namespace petzval {

/// Radiance of the disc, nits: a surface that faces its middle gets the sun's illuminance, pi L
/// sin^2 of the angular radius.
[[nodiscard]] inline Rgb disc_radiance(const SunLight& sun) {
    return sun.illuminance_lx * (1.f / (kPi * sun.versine * (2.f - sun.versine)));
}
/// Density, 1/sr, of direction_in_disc: it is even over the disc.
[[nodiscard]] inline float disc_pdf(const SunLight& sun) {
    return 1.f / (2.f * kPi * sun.versine);
}
/// Unit direction to a point of the disc; u in [0, 1)^2.
[[nodiscard]] inline V3f direction_in_disc(const SunLight& sun, V2f u) {
    const float versine = u.y * sun.versine, sine = safe_sqrt(versine * (2.f - versine));
    const SinCos azimuth = sincos_turns(u.x);
    return unit(Frame::about(-sun.direction)
                    .to_world(V3f(sine * azimuth.cosine, sine * azimuth.sine, 1.f - versine)));
}
/// Whether a unit direction leads to the disc. By the chord: cosines of small angles are rounded
/// away.
[[nodiscard]] inline bool is_in_disc(const SunLight& sun, const V3f& direction) {
    return (direction + sun.direction).length2() <= 2.f * sun.versine;
}

}  // namespace petzval
