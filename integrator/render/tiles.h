// SPDX-License-Identifier: Apache-2.0
// Tiles of a picture, in the order in which they are rendered.
#pragma once

#include <vector>

#include "core/film/film.h"

namespace petzval::integrator {

/// Square tiles (cut at the edges) that cover a crop, along a Hilbert curve, so that neighbours in
/// time are neighbours in the scene. size_px >= 1.
[[nodiscard]] std::vector<Rect> tiles_of(const Rect& crop, int size_px);

}  // namespace petzval::integrator
