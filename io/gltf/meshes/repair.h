// SPDX-License-Identifier: Apache-2.0
// Meshes whose numbers are not as they should be.
#pragma once

#include "core/scene/material.h"
#include "core/scene/mesh.h"

namespace petzval::io {

/// How much was not finite.
struct BrokenValues {
    uint64_t triangles = 0;  ///< with a corner that is not
    uint64_t values = 0;     ///< texture coordinates and colours
};
/// Takes away triangles with a corner that is not finite, and replaces texture coordinates that are
/// not by 0 and colours by 1.
BrokenValues repair_values(Mesh&);

/// Gives the mesh texture coordinates of 0 where a texture of the material needs some and it has
/// none, as OpenGL reads an attribute that is not there; says whether there were such.
bool add_missing_uv(Mesh&, const Material&);

}  // namespace petzval::io
