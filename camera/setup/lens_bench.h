// SPDX-License-Identifier: Apache-2.0
// Lens on the bench: with its film, and the plane that it is focused on. Analyses begin with it.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "camera/bench/aimed_bundle.h"
#include "camera/lens/lens.h"
#include "camera/lens/lens_options.h"

namespace petzval::camera {

struct LensBench {
    std::shared_ptr<const Lens> lens;
    double film_mm = 0;  ///< from the first vertex
    /// From the entrance pupil to the plane in focus; infinite: a distant object.
    double distance_mm = std::numeric_limits<double>::infinity();

    /// The lens as its file has it, for a distant object.
    explicit LensBench(std::shared_ptr<const Lens> as_filed)
        : lens(std::move(as_filed)), film_mm(lens->film_mm()) {}

    /// The lens focused at a distance, as focused_from_pupil() does; nothing where it cannot be.
    [[nodiscard]] static std::optional<LensBench> focused(const Lens&, double distance_mm,
                                                          FocusBy = FocusBy::Paraxial);
    /// Rays from a point of the plane in focus; nothing where none reaches the middle of the stop.
    [[nodiscard]] std::optional<AimedBundle> aim(double field_deg, double nm,
                                                 Section section = Section::Y) const {
        return AimedBundle::aim(*lens, {field_deg, distance_mm, section}, nm);
    }
    /// Shift of the film to the smallest spot on the axis; nothing where no ray gets there.
    [[nodiscard]] std::optional<double> best_film_shift_mm() const;
};

}  // namespace petzval::camera
