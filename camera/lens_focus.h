// SPDX-License-Identifier: Apache-2.0
// Focus and f-number of a lens: what a photographer sets before the picture is taken.
#pragma once

#include <optional>

#include "camera/lens.h"

namespace petzval {

/// The prescription with its film, or its focusing group, where an axial point at object_mm (from
/// the first vertex, < 0; -infinity for a distant one) is sharp at line d, paraxially. Nothing
/// where the lens cannot: the point is too near.
[[nodiscard]] std::optional<Prescription> focused(const Lens&, double object_mm);

/// Real rays of line d from a distant axial point.
struct AxialRay {
    double stop_height_mm;
    double sine;  ///< of its angle with the axis behind the lens
};
/// The ray that enters parallel to the axis at this height; nothing where it does not come through
/// the clear semi-diameters, the stop's left out.
[[nodiscard]] std::optional<AxialRay> axial_ray(const Lens&, double height_mm);

/// Stop radius that gives an f-number 1 / (2 sin u') for a distant axial point; nothing where the
/// glass does not let such a ray through, or no ray has that angle.
[[nodiscard]] std::optional<double> stop_radius_for(const Lens&, double fnumber);
/// The f-number of a stop radius, by the same measure; infinite where no ray gets there.
[[nodiscard]] double fnumber_of(const Lens&, double stop_radius_mm);

}  // namespace petzval
