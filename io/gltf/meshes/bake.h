// SPDX-License-Identifier: Apache-2.0
// Meshes transformed from one space to another.
#pragma once

#include "core/scene/mesh.h"

namespace petzval::io {

/// Transform of a mesh's vertices: positions and tangents by the matrix, normals by the inverse
/// transpose; a matrix that mirrors turns the sign of a tangent's w. All in double.
class VertexTransform {
  public:
    explicit VertexTransform(const M44d& to_world);
    void apply(Mesh&, size_t vertex) const;
    /// Whether front faces come out clockwise.
    [[nodiscard]] bool mirrors() const { return mirrors_; }

  private:
    M44d matrix_, normal_matrix_;
    bool mirrors_;
};

/// Turns the winding of all triangles of a mesh that was mirrored, so that its front faces stay
/// counter-clockwise.
void turn_over(Mesh&);

/// Moves a whole mesh, and turns over one that is mirrored.
void bake(Mesh&, const M44d& to_world);

}  // namespace petzval::io
