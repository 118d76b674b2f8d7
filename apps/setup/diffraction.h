// SPDX-License-Identifier: Apache-2.0
// Diffraction of a setup: whether it changes the picture, and the camera that has it.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "apps/setup/render_setup.h"
#include "core/light/small_features.h"

namespace petzval {

/// What diffraction at the iris does to a picture.
struct DiffractionEffect {
    bool has_iris = false;
    double finest_contrast = 1;  ///< what it leaves to gratings of two pixels, line d
    bool lamp = false;           ///< a small lamp shines in, which gets a star
    /// Whether the picture changes by more than a tolerance of contrast.
    [[nodiscard]] bool matters(double tolerance = kUsualTolerance) const {
        return has_iris && (lamp || finest_contrast < 1 - tolerance);
    }
    /// Reason in words.
    [[nodiscard]] std::string text() const;
};
[[nodiscard]] DiffractionEffect diffraction_effect(const View&, V2i frame_px,
                                                   std::span<const SmallFeature>, const Bvh&);

/// The camera of a view, spread by diffraction where that was asked for and matters. things: the
/// small lamps of the scene and their reflections.
[[nodiscard]] std::shared_ptr<const Camera> with_diffraction(const SceneRequest&, const View&,
                                                             std::span<const SmallFeature> things,
                                                             const Bvh&);

}  // namespace petzval
