// SPDX-License-Identifier: Apache-2.0
// Which volumes are closed, and which of them is there where they overlap.
#pragma once

#include "core/scene/scene.h"

namespace petzval {

/// Sets Material::priority, overlaps_itself and volume_fault of every material in use that
/// refracts, thin_body of every one that is thin glass, and Scene::volume_boxes and volumes_meet.
///
/// A material is a closed volume where all its surfaces together have no border and face outwards,
/// but for those of cavities, and where nothing cuts holes into them. The smaller the largest body
/// of a material is, the higher is its priority: ice is in whisky, a bubble in water. Equal ones
/// are ranked by their place and name, so that the order of files does not matter.
void rank_volumes(Scene&);

}  // namespace petzval
