// SPDX-License-Identifier: Apache-2.0
// Figures of a lens as a whole: distortion, vignetting, and those that its file states.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/bench/aimed_bundle.h"
#include "camera/lens/lens.h"
#include "camera/lens/paraxial.h"

namespace petzval::camera {

/// Half field of use, degrees: what the lens's file states, or else its image circle says; nothing
/// where neither does.
[[nodiscard]] std::optional<double> field_half_deg(const Prescription&);

/// Height on the film of the chief ray (through the middle of the stop), in the object's section;
/// nothing where it is lost. No rim stops it.
[[nodiscard]] std::optional<double> chief_height_mm(const Lens&, const ObjectPoint&, double film_mm,
                                                    double nm = kLineD_nm);

struct Distortion {
    double field_deg;
    double height_mm;        ///< of the chief ray on the film, line d
    double ideal_height_mm;  ///< f tan(field), or the paraxial magnification times the object
    [[nodiscard]] double relative() const { return height_mm / ideal_height_mm - 1; }
};
/// Distortion at a field, 0 < field_deg < 90; f is the paraxial focal length at line d. Nothing
/// where the chief ray is lost.
[[nodiscard]] std::optional<Distortion> distortion(const Lens&, double field_deg, double film_mm,
                                                   double distance_mm,
                                                   Section section = Section::Y);

/// Field angle, from the axis, of the chief ray, line d, that arrives at this height on the film;
/// nothing where there is none within 120 degrees.
[[nodiscard]] std::optional<double> field_of_height_deg(const Lens&, double height_mm,
                                                        double film_mm,
                                                        Section section = Section::Y);

/// Irradiance on the film over the radiance of an even scene, at line d, wide open; x or y is the
/// height. Computed by the camera that renders.
[[nodiscard]] std::vector<double> film_irradiance(std::shared_ptr<const Lens>, double film_mm,
                                                  const std::vector<double>& heights_mm,
                                                  Section section = Section::Y);

/// Figure that a lens's file states, and its computed value.
struct StatedFigure {
    std::string name;  ///< with its unit
    double stated, computed;
    [[nodiscard]] double relative() const { return computed / stated - 1; }
};
/// Stated and computed focal length, f-number and film position, as far as they are stated. With
/// cylinders, those of the section whose focal length is nearer to the stated one.
[[nodiscard]] std::vector<StatedFigure> stated_figures(const Lens&);

/// Field and image circle that a lens's file states, each with its counterpart by a traced chief
/// ray. Neither is a check of the other: a published field often belongs to another film format.
struct FieldAndCircle {
    std::optional<double> half_field_deg, circle_of_half_field_mm;
    std::optional<double> image_circle_mm, half_field_of_image_circle_deg;
};
/// As far as they are stated, and their rays reach the other side. With cylinders, in the section
/// of stated_figures().
[[nodiscard]] FieldAndCircle field_and_circle(const Lens&);

}  // namespace petzval::camera
