// SPDX-License-Identifier: Apache-2.0
// Meshes transformed from one space to another.
#pragma once

#include "core/scene/mesh.h"

namespace petzval {

/// Transform of a mesh's vertices: positions and tangents by the matrix, normals by the inverse
/// transpose. All in double.
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

/// Moves one vertex: as VertexTransform::apply, for matrices that differ by vertex.
void transform_vertex(Mesh&, size_t vertex, const M44d& to_world);

/// Moves a whole mesh; a mirrored one gets its triangles' winding and its tangents' w turned, so
/// that its front faces stay counter-clockwise.
void bake(Mesh&, const M44d& to_world);

}  // namespace petzval
