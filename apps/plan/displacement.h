// SPDX-License-Identifier: Apache-2.0
// Displacement between two cameras: how far apart their rays for one film point meet the scene.
#pragma once

#include "apps/plan/pilot_pixels.h"
#include "camera/camera.h"
#include "camera/setup/focus_plane.h"
#include "core/spectrum/observer.h"
#include "core/traversal/bvh.h"

namespace petzval::apps {

/// A camera with what it needs to be asked.
struct AskedCamera {
    const camera::Camera& camera;
    const Observer& observer;
};

/// Error of the cells of a film where the rays of a camera replace those of another.
struct Displacement {
    FilmMap square_px;   ///< mean square distance where the scene is met, pixels
    FilmMap brightness;  ///< symmetric square of the mean weights
    uint64_t rays = 0;   ///< that were compared
};

/// Displacement of the rays of `other` from those of `base`, which are drawn with the same numbers,
/// over about 144 cells. They are compared where the ray of `base` meets the scene, or far away
/// where it meets nothing, and at the plane of focus and far away too where `at_focus`: the most
/// counts.
[[nodiscard]] Displacement displacement_of(const AskedCamera& other, const AskedCamera& base,
                                           const Scene&, const Bvh&, const camera::FocusPlane&,
                                           V2i size_px, uint32_t rays_per_cell, bool at_focus);

/// Most that the symmetric square of a pixel may be: rays that are moved by a pixel see another
/// picture altogether, and what is brighter or darker is so everywhere.
[[nodiscard]] FilmMap most_error(const Displacement&, double of_itself);

}  // namespace petzval::apps
