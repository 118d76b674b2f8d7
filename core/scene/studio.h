// SPDX-License-Identifier: Apache-2.0
// Built-in studio light, for scenes that nothing lights.
#pragma once

#include "core/scene/sky.h"

namespace petzval {

/// A sky of grey that fades downwards, with three soft boxes: key from the front left, fill from
/// the right, rim from behind. All is white light. glTF's front is +z. A matt white surface shows 1
/// nit where it faces the key light, and less elsewhere.
[[nodiscard]] Sky studio_sky(float rotate_deg = 0.f, float strength = 1.f);

}  // namespace petzval
