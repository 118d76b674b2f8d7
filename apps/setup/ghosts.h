// SPDX-License-Identifier: Apache-2.0
// Ghosts of a traced lens: whether a render shows them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "apps/setup/render_setup.h"
#include "core/light/small_features.h"

namespace petzval::apps {

/// Adds to the camera that renders the ghosts of its lens, beside its own rays or instead of them,
/// where there are any to show. What is the same in another setup of the scene is taken from there;
/// nullptr: there is none. next_step: called again and again, by several threads; an exception of
/// it ends the search.
/// Throws ArgumentError where ghosts alone are asked for and no surface reflects.
void add_ghosts(const CameraRequest&, const RenderSetup* like, const PreparedScene&,
                const std::function<void()>& next_step, View&);

/// Number of the lamps among some things that shine into the lens; 0 where none is traced.
[[nodiscard]] size_t lamps_into_lens(const View&, std::span<const SmallFeature>, const Bvh&);

/// Remark that one of these lamps shines into a lens whose coating reflects nothing; nothing where
/// none does.
[[nodiscard]] std::optional<std::string> ghost_remark(const CameraRequest&, const View&,
                                                      std::span<const SmallFeature>, const Bvh&);

}  // namespace petzval::apps
