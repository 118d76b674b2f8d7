// SPDX-License-Identifier: Apache-2.0
// Focus and f-number of a lens: what a photographer sets before the picture is taken.
#pragma once

#include <limits>
#include <optional>

#include "camera/lens/lens.h"
#include "camera/lens/lens_options.h"

namespace petzval::camera {

/// The lens with its film, or its focusing group, where an axial point at object_mm (from
/// the first vertex of what is returned, < 0; -infinity for a distant one) is sharp. The film is
/// what moves where the file names no group; where it does, the film stands where a distant point
/// is sharp, paraxially, with the group as filed. stop_radius_mm: of the iris, for traced rays; the
/// stop as filed where that is smaller. Nothing where the lens cannot: the point is too near, or,
/// traced, no ray passes.
[[nodiscard]] std::optional<Lens> focused(
    const Lens&, double object_mm, FocusBy = FocusBy::Paraxial,
    double stop_radius_mm = std::numeric_limits<double>::infinity());

/// Shift of the film from film_mm (from the first vertex) to the least mean square radius of the
/// axial spot, as FocusBy::Traced has it. Nothing where no ray passes.
[[nodiscard]] std::optional<double> best_film_shift_mm(
    const Lens&, double film_mm, double object_mm,
    double stop_radius_mm = std::numeric_limits<double>::infinity());

/// Real ray of line d from a distant axial point.
struct AxialRay {
    double stop_height_mm;
    double sine;  ///< of its angle with the axis behind the lens
};
/// Axial ray that enters parallel to the axis at this height; nothing where it does not come
/// through the clear semi-diameters, the stop's left out.
[[nodiscard]] std::optional<AxialRay> axial_ray(const Lens&, double height_mm);

/// Which f-number stop_radius_for() and fnumber_of() mean, for people. Irradiance in the middle of
/// the film follows it but for aberrations.
inline constexpr const char* kTracedFnumber =
    "1 / (2 sin u') of the ray at the iris's rim, from a distant point on the axis, at line d";

/// Stop radius that gives an f-number by kTracedFnumber; nothing where the glass does not let such
/// a ray through, or no ray has that angle.
[[nodiscard]] std::optional<double> stop_radius_for(const Lens&, double fnumber);
/// The lens with its iris at an f-number; nothing where it does not open so far.
[[nodiscard]] std::optional<Prescription> stopped_down(const Lens&, double fnumber);
/// F-number of a stop radius, by kTracedFnumber; infinite where no ray gets there.
[[nodiscard]] double fnumber_of(const Lens&, double stop_radius_mm);

}  // namespace petzval::camera
