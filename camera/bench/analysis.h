// SPDX-License-Identifier: Apache-2.0
// What a lens is like as a whole: distortion, vignetting, and what its file states of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/bench/ray_bundle.h"
#include "camera/lens/lens.h"
#include "camera/lens/paraxial.h"

namespace petzval {

/// The field to which the lens is meant to be used: what its file states, or else its image circle
/// says; nothing where neither does.
[[nodiscard]] std::optional<double> field_half_deg(const Prescription&);

/// Where the ray of line d through the middle of the stop meets the film, in the object's section;
/// nothing where it is lost. No rim stops it.
[[nodiscard]] std::optional<double> chief_height_mm(const Lens&, const ObjectPoint&,
                                                    double film_mm);

struct Distortion {
    double field_deg;
    double height_mm;  ///< where the ray through the middle of the stop meets the film, line d
    double ideal_height_mm;  ///< f tan(field), or the paraxial magnification times the object
    [[nodiscard]] double relative() const { return height_mm / ideal_height_mm - 1; }
};
/// 0 < field_deg < 90. f is the paraxial focal length at line d. Nothing where that ray is lost.
[[nodiscard]] std::optional<Distortion> distortion(const Lens&, double field_deg, double film_mm,
                                                   double distance_mm,
                                                   Section section = Section::Y);

/// The angle from the axis of the ray that arrives at this height on the film through the middle
/// of the stop, line d; nothing where there is none within 120 degrees.
[[nodiscard]] std::optional<double> field_of_height_deg(const Lens&, double height_mm,
                                                        double film_mm,
                                                        Section section = Section::Y);

/// Irradiance on the film over the radiance of an even scene, at line d, wide open; x or y is the
/// height. By the camera that renders.
[[nodiscard]] std::vector<double> film_irradiance(std::shared_ptr<const Lens>, double film_mm,
                                                  const std::vector<double>& heights_mm,
                                                  Section section = Section::Y);

/// A figure that a lens's file states, and what comes out.
struct StatedFigure {
    std::string name;  ///< with its unit
    double stated, computed;
    [[nodiscard]] double relative() const { return computed / stated - 1; }
};
/// Focal length, f-number, half field and where the film stands, as far as they are stated. With
/// cylinders the section whose focal length is nearer to the stated one speaks for the lens.
[[nodiscard]] std::vector<StatedFigure> stated_figures(const Lens&);

}  // namespace petzval
