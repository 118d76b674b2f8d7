// SPDX-License-Identifier: Apache-2.0
// Which volumes are closed, and which of them is there where they overlap.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace petzval {

/// Sets Material::priority and overlaps_itself of every material that refracts, and
/// Scene::nested_bounds. A material is a closed volume where all its surfaces together have no
/// border and face outwards, but for those of cavities; materials with holes in their coverage are
/// not. The smaller
/// the largest body of a material is, the higher is its priority: ice is in whisky, a bubble in
/// water. Equal ones are ranked by their place and name, so that the order of files does not
/// matter.
void rank_volumes(Scene&);

/// Why a material that refracts is no closed volume: its surface has a border, or faces inwards, or
/// holds nothing.
enum class VolumeFault { Open, InsideOut, Flat };
struct FaultyVolume {
    uint32_t material;
    VolumeFault fault;
};
/// Materials in use that refract and are no closed volumes, in the order of the scene's materials.
[[nodiscard]] std::vector<FaultyVolume> faulty_volumes(const Scene&);

}  // namespace petzval
