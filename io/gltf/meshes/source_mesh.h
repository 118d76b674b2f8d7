// SPDX-License-Identifier: Apache-2.0
// Meshes whose vertices were split, and what the file says of each vertex.
#pragma once

#include "core/scene/mesh.h"

namespace petzval::io {

/// A primitive's mesh, and where in the file each of its vertices stands. Whatever splits vertices
/// does so by gather(). What the file says of a vertex beside the mesh (joints, weights, morph
/// targets) is found by in_file().
class SourceMesh {
  public:
    SourceMesh() = default;
    /// Of a mesh that has the file's vertices, in their order.
    explicit SourceMesh(Mesh of_file) : mesh(std::move(of_file)) {}

    Mesh mesh;

    /// Number of a vertex of the mesh in the attributes of the file.
    [[nodiscard]] size_t in_file(size_t vertex) const {
        return file_vertex_.empty() ? vertex : file_vertex_[vertex];
    }

    /// New vertex i becomes a copy of vertex from[i], with all that belongs to it. Triangles keep
    /// their numbers: they are the caller's.
    void gather(const std::vector<uint32_t>& from);

    /// Takes positions, normals and tangents from a mesh that has the file's vertices, in their
    /// order; all else stays.
    void take_shape(Mesh&& of_file);

  private:
    std::vector<uint32_t> file_vertex_;  ///< empty: no vertex was split
};

}  // namespace petzval::io
