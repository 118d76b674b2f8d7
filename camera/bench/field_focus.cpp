// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/field_focus.h"

#include <cmath>

namespace petzval::camera {

std::optional<FieldFocus> field_focus(const AimedBundle& bundle, double film_mm) {
    constexpr double close = 1e-3;
    const size_t along = bundle.object().section == Section::X ? 0 : 1;
    const PupilPoint chief = bundle.chief();
    // Rays beside the chief ray, and how their distance along an axis of the film changes.
    const auto focus = [&](size_t moves, size_t axis) -> std::optional<double> {
        PupilPoint one = chief, other = chief;
        const double by = close * (bundle.most()[moves] - bundle.least()[moves]);
        one[moves] -= by;
        other[moves] += by;
        const auto rays = bundle.trace(std::array{one, other}, film_mm, Clip::No);
        if (rays.size() < 2) return std::nullopt;
        const double shift_mm = -(rays[1].film_mm[axis] - rays[0].film_mm[axis]) /
                                (rays[1].slope[axis] - rays[0].slope[axis]);
        return std::isfinite(shift_mm) ? std::optional(shift_mm) : std::nullopt;
    };
    const auto tangential = focus(1, along), sagittal = focus(0, 1 - along);
    if (!tangential || !sagittal) return std::nullopt;
    return FieldFocus{*tangential, *sagittal};
}

}  // namespace petzval::camera
