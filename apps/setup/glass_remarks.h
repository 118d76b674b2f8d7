// SPDX-License-Identifier: Apache-2.0
// What a user should know of the glass in a scene: volumes that are not closed, light that is lost.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "integrator/lost_light.h"

namespace petzval {

/// Remark on materials that refract and are no closed volumes, with what to do; empty where all
/// are.
[[nodiscard]] std::string faulty_volumes_text(const Scene&);
/// Remark on light that no path finds: which lights, behind what, and what to do; empty where
/// there is none.
[[nodiscard]] std::string lost_light_text(const Scene&, const std::vector<LostLight>&);

}  // namespace petzval
