// SPDX-License-Identifier: Apache-2.0
// Normals and tangents that a glTF file leaves to the reader.
#pragma once

#include "core/scene/mesh.h"
#include "core/scene/texture.h"
#include "io/gltf/meshes/source_mesh.h"

namespace petzval::io {

/// Scales normals to unit length. One without a length (or not finite) becomes the mean of the
/// faces around it, weighted by area; returns how many there were.
size_t repair_normals(Mesh&);

/// Scales tangents to unit length, makes w +-1, in a mesh that has normals if it has tangents. One
/// that is useless is replaced by some direction across the normal.
void repair_tangents(Mesh&);

/// Splits vertices that cannot have one tangent for all their faces: those between faces whose
/// textures are mirrored, and in a flat-shaded mesh all that are shared. Nothing happens without
/// texture coordinates.
void split_for_tangents(SourceMesh&, const TextureSlot& normal_map);

/// Computes tangents for a normal map from the texture coordinates that it is read with: along
/// increasing u, averaged over the faces about each vertex by their angle there. Vertices are as
/// split_for_tangents() leaves them. In the spirit of Mikkelsen 2008, "Simulation of Wrinkled
/// Surfaces Revisited", with the sign of glTF 2.0, section 3.7.2.1 (v runs down, green points up).
/// Nothing happens without coordinates.
void add_tangents(Mesh&, const TextureSlot& normal_map);

}  // namespace petzval::io
