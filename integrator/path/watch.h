// SPDX-License-Identifier: Apache-2.0
// Watch on a path: hears of each step. A render has nobody who looks on: its calls vanish.
#pragma once

#include <optional>
#include <vector>

#include "core/light/light_choice.h"
#include "core/shading/surface.h"

namespace petzval::integrator {

/// Step of a path, with the members of PathEvent that it has. SampleRecord adds holes and what
/// blocks, and distances. The last of a path says why it ends; light, that nothing is left.
enum class PathStep : uint8_t {
    Begins,         ///< ray; of a SampleRecord lanes: weight on the film
    Hole,           ///< surface with a hole in its coverage; number: distance, m
    Culled,         ///< surface of which the ray sees nothing; number: distance, m
    Meets,          ///< surface; lanes: throughput; medium; number: distance, m
    Hidden,         ///< nothing changes at this face of a volume
    Shines,         ///< lanes: light that the surface sends
    DrawsLight,     ///< light
    ShadowRay,      ///< ray; number: share that comes through
    Blocks,         ///< surface that stops it; number: distance, m
    Scatters,       ///< lanes: light that was sampled
    GoesOn,         ///< drawn; straight
    Roulette,       ///< number: chance to go on
    LeavesScene,    ///< ray
    Sky,            ///< lanes: light from behind the scene
    Unlit,          ///< the surface shows its colour and scatters nothing
    MaxDepth,       ///< PathOptions::max_depth
    MaxClearDepth,  ///< PathOptions::max_specular_depth
    Absorbed,       ///< nothing goes where the BSDF was sampled
    LeftToOthers,   ///< a ray to a target: ordinary ones find what is scattered far and wide
    NotFinite       ///< the direction that was drawn is no number
};

struct PathEvent {
    PathStep step;
    f4 lanes{};
    float number = 0;
    uint32_t light = 0;                ///< index into Scene::lights
    const Material* medium = nullptr;  ///< volume on the way, or null
    std::optional<Surface> surface{};
    Ray ray{};
    BsdfSample drawn{};
    bool straight = false;  ///< through a pane
};

/// Watch of a render.
struct Unwatched {
    static void sees(const PathEvent&) {}
    /// Returns the light, which is added to what the path has found.
    static f4 adds(PathStep, f4 light) { return light; }
    static std::nullopt_t ends(PathStep) { return std::nullopt; }
    /// Hears of the light that was drawn for a receiver, if any, and of what it brought.
    static void sampled(const LightChoice&, std::optional<uint32_t>, const LightReceiver&, f4) {}
};

/// Watch that keeps what it sees, path after path.
struct PathRecorder : Unwatched {
    std::vector<PathEvent>* to;

    void sees(const PathEvent& event) const { to->push_back(event); }
    f4 adds(PathStep step, f4 light) const { return sees({.step = step, .lanes = light}), light; }
    std::nullopt_t ends(PathStep why) const { return sees({.step = why}), std::nullopt; }
};

}  // namespace petzval::integrator
