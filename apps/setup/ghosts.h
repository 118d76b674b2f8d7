// SPDX-License-Identifier: Apache-2.0
// Ghosts of a traced lens: whether a render shows them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "apps/setup/render_setup.h"
#include "core/light/small_features.h"

namespace petzval {

/// The camera that renders with its lens's ghosts beside its own rays, or without; itself where
/// there are none to show. Throws ArgumentError where ghosts alone are asked for and no surface
/// reflects.
[[nodiscard]] std::shared_ptr<const Camera> with_ghosts(const CameraRequest&, const View&,
                                                        const Scene&, const Bvh&);

/// Remark that one of these lamps shines into a lens whose coating reflects nothing; nothing where
/// none does.
[[nodiscard]] std::optional<std::string> ghost_remark(const CameraRequest&, const View&,
                                                      std::span<const SmallFeature>, const Bvh&);

}  // namespace petzval
