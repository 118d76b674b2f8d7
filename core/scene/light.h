// SPDX-License-Identifier: Apache-2.0
// The six kinds of light that a scene may hold.
#pragma once

#include <cstdint>
#include <variant>

#include "core/math/math.h"
#include "core/scene/beam.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// KHR_lights_punctual "point".
struct PointLight {
    V3f position;
    Rgb intensity_cd;
    int32_t illuminant = -1;  ///< white, index into Scene::illuminants; -1: the scene's
};
/// KHR_lights_punctual "spot": intensity falls off between the two cones as its specification says.
struct SpotLight {
    V3f position, direction;  ///< unit, the way the light shines
    Rgb intensity_cd;
    float cos_inner, cos_outer;
    int32_t illuminant = -1;

    [[nodiscard]] Beam beam() const { return {direction, cos_inner, cos_outer}; }
};
/// A point that sends what a LightProfile says: EXT_lights_ies.
struct ProfileLight {
    V3f position;
    V3f x, y, f;       ///< unit axes of the profile in the scene
    Rgb factor;        ///< on the profile's intensities
    uint32_t profile;  ///< index into Scene::profiles
    int32_t illuminant = -1;
};
/// KHR_lights_punctual "directional", as a point of the sky or an even disc of it.
struct SunLight {
    V3f direction;  ///< unit, the way the light shines; of a disc: from its middle
    Rgb illuminance_lx;
    int32_t illuminant = -1;
    float versine = 0;    ///< 1 - cosine of the disc's angular radius, at most 1; 0: a point
    bool unseen = false;  ///< camera rays do not meet the disc

    [[nodiscard]] bool has_disc() const { return versine > 0; }
};
/// One emissive triangle of an instance.
struct TriangleLight {
    uint32_t instance, triangle;
};
/// The scene's sky (core/scene/sky.h): an environment picture or a uniform colour.
struct SkyLight {};

using Light = std::variant<PointLight, SpotLight, SunLight, TriangleLight, SkyLight, ProfileLight>;

}  // namespace petzval
