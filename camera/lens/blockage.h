// SPDX-License-Identifier: Apache-2.0
// Blockage: why a lens lets no light through.
#pragma once

#include <optional>
#include <string>

#include "camera/lens/lens.h"
#include "camera/lens/lens_ray.h"

namespace petzval::camera {

/// Surface that stops the rays of the film's middle, and how.
struct Blockage {
    int surface;  ///< from 0
    RayStatus status;
    int stopped, rays;  ///< of all rays, those that end there in this way

    /// Says in words what stops the rays, and what to look at in the lens's file.
    [[nodiscard]] std::string text() const;
};

/// The surface that stops the most of the rays, line d, that leave the film's middle for the
/// paraxial exit pupil; nothing where a tenth of them or more passes the lens. The lens is in
/// focus.
[[nodiscard]] std::optional<Blockage> find_blockage(const Lens&);

/// Irradiance of the film's middle over the radiance of an even scene, by rays near the axis: the
/// solid angle of the exit pupil as a flat cap, in proportion to an iris of that area. Infinite
/// where the pupil is in the film.
[[nodiscard]] double paraxial_irradiance(const Lens&, double iris_area_mm2);

}  // namespace petzval::camera
