// SPDX-License-Identifier: Apache-2.0
// Remarks on the glass in a scene: bodies without a volume, volumes that are not closed, light that
// is lost.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "integrator/prepass/lost_light.h"

namespace petzval::apps {

/// A remark on thin glass in the shape of a body, one on materials that refract and are no closed
/// volumes, and one on light that no path finds: which, behind what, and what to do. None where
/// there is nothing of the kind.
[[nodiscard]] std::vector<std::string> glass_remarks(const Scene&,
                                                     const std::vector<integrator::LostLight>&);

}  // namespace petzval::apps
