// SPDX-License-Identifier: Apache-2.0
// Options of paths: their length, the light they sample, and what camera rays see behind the scene.
#pragma once

#include <optional>

#include "core/spectrum/bands.h"

namespace petzval::integrator {

/// Light transport technique. Mis: light and BSDF samples, weighted by the power heuristic. The
/// other two are the halves of it, each complete by itself where it can reach the light at all;
/// tests hold all three together.
enum class Technique { Mis, LightOnly, BsdfOnly };

struct PathOptions {
    int max_depth = 16;  ///< scatterings but for those at clear glass; 0 shows emitters only
    int max_specular_depth = 256;  ///< reflections and refractions at clear glass
    int roulette_depth = 1;        ///< scatterings before Russian roulette begins
    Technique technique = Technique::Mis;
    /// Background that camera rays see in place of the sky; its light stays.
    std::optional<Rgb> visible_background;
    bool transparent = false;  ///< camera rays that miss leave alpha 0 and no light
};

}  // namespace petzval::integrator
