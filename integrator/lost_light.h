// SPDX-License-Identifier: Apache-2.0
// Light that no path finds: of lamps behind solid, smooth glass.
#pragma once

#include <vector>

#include "core/light/things.h"
#include "core/traversal/bvh.h"

namespace petzval {

/// A light, and the glass that most of what is lost goes through.
struct LostLight {
    enum class Kind : uint8_t { Point, Spot, Sun, Lamp, SkySpot };
    Kind kind;
    uint32_t light = 0;  ///< of a punctual one: index into Scene::lights
    double size = 0;     ///< of a lamp: diameter, metres; of a spot of the sky: radians
    uint32_t glass = 0;  ///< index into Scene::materials
    /// Of what it sends to surfaces, a lamp all about, others where the glass is: that which goes
    /// through glass first.
    double share = 0;
};

/// Chance below which a path that leaves a surface counts as never meeting a lamp.
inline constexpr double kHardlyAnyPath = 1e-4;

/// Lights of which at least a hundredth (LostLight::share) goes through solid, smooth glass and
/// then to a surface, where the path tracer does not find it: shadow rays end at the glass, and a
/// path that goes back through it meets a light without size never, and another with a chance below
/// kHardlyAnyPath. The glass is not taken to bend. A pure function of the scene; 256 rays a light.
[[nodiscard]] std::vector<LostLight> lost_light(const Scene&, const Bvh&);

}  // namespace petzval
