// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/source_mesh.h"

#include <numeric>

namespace petzval::io {
namespace {

template <class Value>
void gather_values(std::vector<Value>& values, const std::vector<uint32_t>& from) {
    if (values.empty()) return;
    std::vector<Value> gathered;
    gathered.reserve(from.size());
    for (const uint32_t i : from) gathered.push_back(values[i]);
    values = std::move(gathered);
}

/// Calls visit with each array of values by vertex. Bindings name every member, so that one that is
/// added does not compile until it is looked at here.
template <class Visit>
void each_vertex_array(Mesh& mesh, Visit visit) {
    auto& [positions, normals, tangents, uv, more_uv, colours, triangles, material, steps,
           colours_from] = mesh;
    visit(positions);
    visit(normals);
    visit(tangents);
    for (auto& set : uv) visit(set);
    for (auto& set : more_uv) visit(set);
    visit(colours);
    for (MeshStep& step : steps) {
        auto& [positions_then, normals_then, tangents_then] = step;
        visit(positions_then);
        visit(normals_then);
        visit(tangents_then);
    }
}

}  // namespace

void SourceMesh::gather(const std::vector<uint32_t>& from) {
    if (file_vertex_.empty()) {
        file_vertex_.resize(mesh.positions.size());
        std::iota(file_vertex_.begin(), file_vertex_.end(), 0u);
    }
    gather_values(file_vertex_, from);
    each_vertex_array(mesh, [&](auto& values) { gather_values(values, from); });
}

void SourceMesh::take_shape(Mesh&& of_file) {
    mesh.positions = std::move(of_file.positions);
    mesh.normals = std::move(of_file.normals);
    mesh.tangents = std::move(of_file.tangents);
    if (file_vertex_.empty()) return;
    gather_values(mesh.positions, file_vertex_);
    gather_values(mesh.normals, file_vertex_);
    gather_values(mesh.tangents, file_vertex_);
}

}  // namespace petzval::io
