// SPDX-License-Identifier: Apache-2.0
// Paraxial optics of a lens, and its third-order (Seidel) aberrations.
#pragma once

#include <array>
#include <vector>

#include "camera/lens/lens.h"

namespace petzval::camera {

/// Plane in which paraxial rays are followed: it matters where there are cylinders.
enum class Section : uint8_t { X, Y };

/// First-order data at a wavelength. Millimetres along the axis; infinite where there is none, as
/// the focal length of an afocal lens.
struct FirstOrder {
    double focal_length_mm;
    double back_focus_mm;       ///< from the last vertex
    double front_focus_mm;      ///< from the first vertex
    double front_principal_mm;  ///< from the first vertex
    double rear_principal_mm;   ///< from the last vertex
    double entrance_pupil_mm;   ///< from the first vertex
    double exit_pupil_mm;       ///< from the last vertex
    double entrance_pupil_diameter_mm, exit_pupil_diameter_mm;
    double fnumber;  ///< |focal length| / entrance pupil diameter: for a distant object
};
[[nodiscard]] FirstOrder first_order(const Lens&, double nm, Section = Section::Y);

/// Heights at which the paraxial ray of line d that arrives parallel to the axis, 1 mm from it,
/// meets the surfaces, mm.
[[nodiscard]] std::vector<double> marginal_heights_mm(const std::vector<LensSurface>&, Section);

struct ParaxialImage {
    double from_last_vertex_mm;
    double magnification;  ///< height of the image over that of the object
};
/// Paraxial image of an object at object_mm (from the first vertex, < 0 before the lens).
[[nodiscard]] ParaxialImage image_of(const Lens&, double object_mm, double nm,
                                     Section = Section::Y);

/// Welford's sums S1 to S5 (spherical aberration, coma, astigmatism, Petzval curvature, distortion)
/// and his C1, C2 (axial and lateral colour, F to C), mm: wavefront W040 = S1 / 8 and so on.
/// Welford 1986, Aberrations of Optical Systems, ch. 8 and 10.
using SeidelSums = std::array<double, 7>;

struct Seidel {
    std::vector<SeidelSums> of_surface;
    SeidelSums total{};
};
/// Seidel sums for a distant object at field_tan = tan(angle from the axis) and the full aperture,
/// at line d. Throws std::invalid_argument where the lens has cylinders.
[[nodiscard]] Seidel seidel(const Lens&, double field_tan);

}  // namespace petzval::camera
