// SPDX-License-Identifier: Apache-2.0
// Diffraction of a setup: whether it changes the picture, and the camera that has it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/setup/render_setup.h"

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
[[nodiscard]] DiffractionEffect diffraction_effect(const View&, V2i frame_px, const Scene&,
                                                   const Bvh&);

/// Remark on what is wrong where a traced lens errs by too much for rays and pattern to be told
/// apart, in words; nothing where that is below a hundredth of contrast. focus_m: distance from the
/// entrance pupil of what is sharp. Up to a second of CPU time.
[[nodiscard]] std::optional<std::string> diffraction_doubt(const View&, V2i frame_px,
                                                           double focus_m);

/// Spreads the camera of a view by diffraction where that was asked for and matters. like: nullptr,
/// or a setup from which it is taken where rays, scene and size are the same.
void add_diffraction(const SceneRequest&, const RenderSetup* like, const PreparedScene&, View&);

}  // namespace petzval
