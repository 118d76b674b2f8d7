// SPDX-License-Identifier: Apache-2.0
// Focus over the field: where close rays meet the chief ray.
#pragma once

#include <optional>

#include "camera/bench/aimed_bundle.h"

namespace petzval::camera {

/// Foci of the rays close to the chief ray, mm behind the film along the axis.
struct FieldFocus {
    double tangential_mm;  ///< of rays in the plane of the field
    double sagittal_mm;    ///< of rays across it
};
/// By rays a thousandth of the aperture from the chief ray, which rims do not stop; nothing where
/// they are lost or leave parallel.
[[nodiscard]] std::optional<FieldFocus> field_focus(const AimedBundle&, double film_mm);

}  // namespace petzval::camera
