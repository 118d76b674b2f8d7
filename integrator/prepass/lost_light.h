// SPDX-License-Identifier: Apache-2.0
// Light that no path finds: of lamps behind solid, smooth glass.
#pragma once

#include <vector>

#include "core/light/small_features.h"
#include "core/traversal/bvh.h"

namespace petzval::integrator {

/// A light, and the glass that most of what is lost goes through.
struct LostLight {
    enum class Kind : uint8_t { Point, Spot, Sun, Lamp, SkySpot };
    Kind kind;
    uint32_t light = 0;  ///< of a punctual one: index into Scene::lights
    /// Of a lamp: diameter of a ball about it, metres; of a spot of the sky: radians.
    double size = 0;
    uint32_t glass = 0;  ///< index into Scene::materials
    /// Of the rays that were sent, a lamp's all about and others' at the glass: those that went
    /// through glass first, and then to a surface.
    double share = 0;
};

/// Chance below which a path that leaves a surface counts as never meeting a lamp.
inline constexpr double kHardlyAnyPath = 1e-4;

/// Lights that shine through solid, smooth glass onto a surface, where the path tracer does not
/// find them: shadow rays end at the glass, and a path that goes back through it meets a light
/// without size never, and another with a chance below kHardlyAnyPath. Lamps count from a hundredth
/// of their light on. The glass is not taken to bend. Up to 512 punctual lights, 256 rays a light;
/// a pure function of the scene.
[[nodiscard]] std::vector<LostLight> lost_light(const Scene&, const Bvh&);

}  // namespace petzval::integrator
