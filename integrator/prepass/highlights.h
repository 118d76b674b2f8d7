// SPDX-License-Identifier: Apache-2.0
// Highlights: virtual images of lamps in polished surfaces, and images of lamps behind clear glass.
#pragma once

#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/run_tasks.h"
#include "core/light/small_features.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"

namespace petzval::integrator {

/// Images of lamps in polished surfaces and behind clear glass that a camera sees, as lamps at the
/// places where they seem to be: at most 1,024, and none in a frame narrower than a cell of 16
/// pixels. Lamps are taken from the things, lights without size from the scene.
///
/// A few camera rays of each cell of the frame find polished surfaces, and a ray to the middle of
/// objects that they pass by. From there Newton's method looks for the point whose normal lies
/// half-way between the directions to the lens and to the lamp, or for the ray that glass bends to
/// the lamp. The same for other points of the lens. At most a seventh of a ray is cast for a pixel,
/// and one more where images are found; one that glass bends counts as several in the search, and
/// as one before it. An object is looked at first where the one before showed the lamp. A pure
/// function of the arguments. What each cell casts first is a task; the caller's thread does the
/// rest.
[[nodiscard]] std::vector<SmallFeature> highlights(const camera::Camera&, const Scene&, const Bvh&,
                                                   V2i frame_px,
                                                   std::span<const SmallFeature> features,
                                                   const camera::RunTasks& = camera::one_by_one);

}  // namespace petzval::integrator
