// SPDX-License-Identifier: Apache-2.0
// Rays of a bundle as they are drawn in a section of a lens.
#pragma once

#include "camera/bench/aimed_bundle.h"
#include "camera/lens/profile.h"

namespace petzval::camera {

/// Pupil points of so many rays in the bundle's section, from one edge of its light to the other;
/// the chief ray where it is one.
[[nodiscard]] std::vector<PupilPoint> section_points(const AimedBundle&, int count);

/// Path of a ray in the bundle's section, {z, height} in mm: from lead_mm before the first face, or
/// its plane, to the film or to where it ends.
[[nodiscard]] Outline ray_path(const Lens&, const AimedBundle&, PupilPoint, double film_mm,
                               double lead_mm);

}  // namespace petzval::camera
