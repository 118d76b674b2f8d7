// SPDX-License-Identifier: Apache-2.0
// From the rays of an image to what rays through all points of the lens have in common.
#pragma once

#include <optional>
#include <vector>

#include "core/light/small_features.h"
#include "integrator/prepass/highlight_search.h"

namespace petzval::integrator {

/// The image that several points of the lens see, as a lamp at the place where it seems to be;
/// nothing where fewer than four agree, or it lies behind the lens.
[[nodiscard]] std::optional<SmallFeature> lamp_of(std::vector<LampImage>, const Source&);

}  // namespace petzval::integrator
