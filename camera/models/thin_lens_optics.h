// SPDX-License-Identifier: Apache-2.0
// Closed forms of a thin lens in air: imaging, blur, spherical and chromatic aberration. Distances
// are in mm, positive and along the axis: object to lens, lens to film; infinity is a distance like
// any other. Errors: std::invalid_argument, in words for the user who chose the numbers.
#pragma once

#include <optional>

#include "core/spectrum/glass.h"

namespace petzval::camera {

/// Film distance S' at which an object at S is sharp: 1/S + 1/S' = 1/f (Gauss 1840).
/// Error: the object is not beyond the focal length, so no film can catch it.
[[nodiscard]] double image_distance_mm(double focal_mm, double object_mm);
/// Object distance S that is sharp on a film at S'; infinity where S' is the focal length.
/// Error: the film is nearer than the focal length.
[[nodiscard]] double object_distance_mm(double focal_mm, double film_mm);
/// Focal length that images S on S'.
[[nodiscard]] double focal_length_between_mm(double object_mm, double film_mm);

/// Thin lens at one wavelength.
struct SingletOptics {
    double n;         ///< index, above 1
    double focal_mm;  ///< of rays near the axis, above 0
    double bending;   ///< q = (r2 + r1) / (r2 - r1): 0 equiconvex, 1 flat towards the film
};

/// Lens of one glass. A radius is positive where its centre lies on the film's side; infinity is a
/// flat surface. r1 faces the scene.
struct Singlet {
    Glass glass;
    double r1_mm, r2_mm;

    /// Singlet of that focal length at the d line, and that bending q.
    [[nodiscard]] static Singlet bent(Glass, double focal_mm, double bending);
    /// Lens at an index, by the lensmaker's equation 1/f = (n - 1) (1/r1 - 1/r2). Error: no glass,
    /// or not a lens that gathers light.
    [[nodiscard]] SingletOptics at_index(double n) const;
    /// Lens in light of that wavelength.
    [[nodiscard]] SingletOptics at(double nm) const;
};

/// Spherical coefficient K of f0 - f(h) = K h^2 / 2, 1/mm, for the object distance S: Jenkins and
/// White 1976, "Fundamentals of Optics", 9.5, with q as above and p = (S' - S) / (S' + S), -1 at
/// infinity.
[[nodiscard]] double spherical_coefficient_per_mm(const SingletOptics&, double object_mm);
/// Zonal focal length f(h), for a ray that meets the lens h_mm off the axis and comes from S on the
/// axis. Not positive where h is far out of the formula's domain.
[[nodiscard]] double zonal_focal_length_mm(const SingletOptics&, double object_mm, double h_mm);
/// Longitudinal spherical aberration: how far before S' such a ray meets the axis, S' minus the
/// image distance for f(h). To first order that is (S'/f)^2 K h^2 / 2, and K h^2 / 2 itself only
/// for an object at infinity. For n from 1.5 to 1.8, |q| <= 2 and S >= 1.5 f it is within 1 % of
/// exact traces up to h = f/16 and within 10 % up to h = f/5.
[[nodiscard]] double spherical_aberration_mm(const SingletOptics&, double object_mm, double h_mm);
/// Longitudinal spherical aberration by Snell's law at two spheres that touch at the lens's centre;
/// h_mm is where the incoming ray crosses the plane through it. Nothing where the ray misses or is
/// reflected within.
[[nodiscard]] std::optional<double> traced_spherical_aberration_mm(const SingletOptics&,
                                                                   double object_mm, double h_mm);
/// Error |formula / trace - 1| for the ray at h_mm; infinite where no such ray comes through. At
/// the stop's radius it says how far the formula may be trusted: a program should warn above 0.1.
[[nodiscard]] double spherical_aberration_error(const SingletOptics&, double object_mm,
                                                double h_mm);

/// Greatest radius of the stop, at most radius_mm and 2 % too small, whose
/// spherical_aberration_error is within most_error; a millionth of the focal length where none is.
[[nodiscard]] double radius_within_error(const SingletOptics&, double focus_mm, double radius_mm,
                                         double most_error);

}  // namespace petzval::camera
