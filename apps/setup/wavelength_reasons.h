// SPDX-License-Identifier: Apache-2.0
// What in a scene RGB cannot tell, and how far its glasses are known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace petzval {

/// One phrase for each kind of thing in the scene that depends on wavelength, with the first of
/// that kind and how many more there are: "material "prism" disperses (schott:N-SF11), and 3 more".
/// Kinds: glass that disperses, measured metal, material that shines as an illuminant, light that
/// does. Empty where RGB tells all.
[[nodiscard]] std::vector<std::string> reasons_for_wavelengths(const Scene&);

/// A line for each different glass whose formula does not cover kFirst_nm to kLast_nm.
[[nodiscard]] std::vector<std::string> glass_range_warnings(const Scene&);

/// What is wrong with asking for the light from first_nm to last_nm: the first glass that is not
/// known so far. Nothing where all are.
[[nodiscard]] std::optional<std::string> glass_beyond(const Scene&, double first_nm,
                                                      double last_nm);

}  // namespace petzval
