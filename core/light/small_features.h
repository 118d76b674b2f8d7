// SPDX-License-Identifier: Apache-2.0
// Small features of a scene, which a few pixels may hold and a plan must not miss: what depends on
// wavelength, and what shines.
#pragma once

#include <optional>
#include <vector>

#include "core/math/astigmatic_image.h"
#include "core/scene/scene.h"

namespace petzval {

/// A part of a scene, by the sphere around it.
struct SmallFeature {
    enum class Kind : uint8_t {
        Wavelength,  ///< refracts, reflects or emits by wavelength
        Lamp         ///< emits, or is a bright spot of the sky or the disc of a sun
    };
    Kind kind;
    V3f centre;                ///< metres; a unit direction for what lies at infinity
    float radius_m = 0;        ///< of a sphere around its box; at infinity: radians
    float reach_m = 0;         ///< from its centre to its farthest point, tighter; likewise
    bool at_infinity = false;  ///< a spot of the sky
    double area_m2 = 0;        ///< of a lamp: half its surface; at infinity: sr
    double radiance = 0;       ///< of a lamp: mean luminance, nits
    std::optional<AstigmaticImage> image{};  ///< of a lamp that is seen mirrored or through glass

    /// Whether it is a lamp.
    [[nodiscard]] bool is_lamp() const { return kind == Kind::Lamp; }
};

/// Small features of a scene, seldom more than a hundred: an object whose parts lie apart counts as
/// several, and so do bright parts of emissive textures and of the sky. At most so many are made of
/// the lamps of one class of brightness, of which there are four, each a hundred times as dark as
/// the one before. What is found in textures comes from up to 2^18 points. A pure function of the
/// scene.
[[nodiscard]] std::vector<SmallFeature> small_features_of(const Scene&, size_t most_of_class = 32);

}  // namespace petzval
