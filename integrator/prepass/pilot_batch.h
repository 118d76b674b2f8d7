// SPDX-License-Identifier: Apache-2.0
// Single pixels of a frame, rendered to learn something of a picture before it is rendered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "camera/camera.h"
#include "core/film/film.h"
#include "integrator/path/path.h"
#include "integrator/render/executor.h"
#include "integrator/render/render_job.h"

namespace petzval::integrator {

/// A turn of a pilot, of which there are more until enough pixels have light: many pixels with few
/// samples find small things.
struct PilotTurn {
    int pixels;
    uint32_t samples;
};
/// Pixels with light that are enough to judge a picture by.
inline constexpr size_t kEnoughLitPixels = 16;

/// What a pilot renders.
struct PilotBatch {
    V2i frame_px;
    std::vector<std::array<int, 2>> pixels;
    uint32_t first = 0, end = 1;  ///< samples of each pixel and seed
    std::vector<uint32_t> seeds;  ///< a replicate each
    std::vector<Aov> layers;
};

/// A pixel of a pilot with the samples of one replicate.
struct PilotFilm {
    size_t pixel, replicate;  ///< indices of PilotBatch::pixels and seeds
    V4f colour;               ///< nits, and alpha
    V3f layer;                ///< the first of PilotBatch::layers, 0 where there is none
    uint32_t samples;
    double seconds;  ///< that they took
};

/// Counts of the paths. Gives every pixel and replicate to `found`, which several threads call,
/// each for pixels of its own; the replicates of a pixel come in their order. Sampler, filter,
/// observer and replicates are the job's.
PathStats render_pilot(const PathTracer<>&, const camera::Camera&, const RenderJob&,
                       const PilotBatch&, TbbExecutor&,
                       const std::function<void(const PilotFilm&)>& found);

}  // namespace petzval::integrator
