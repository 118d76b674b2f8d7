// SPDX-License-Identifier: Apache-2.0
// Meshes whose numbers are not as they should be.
#pragma once

#include "core/scene/material.h"
#include "core/scene/mesh.h"
#include "io/gltf/tally.h"

namespace petzval {

/// Takes away triangles with a corner that is not finite, and replaces texture coordinates that are
/// not by 0 and colours by 1; counts all of them.
void repair_values(Mesh&, GltfTally&);

/// Gives the mesh texture coordinates of 0 where a texture of the material needs some and it has
/// none, as OpenGL reads an attribute that is not there; says whether there were such.
bool add_missing_uv(Mesh&, const Material&);

}  // namespace petzval
