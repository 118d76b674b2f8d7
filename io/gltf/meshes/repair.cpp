// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/repair.h"

#include <algorithm>

namespace petzval::io {
namespace {

template <class Value>
uint64_t replace_broken(std::vector<Value>& values, const Value& by) {
    uint64_t count = 0;
    for (Value& value : values) {
        if (is_finite(value)) continue;
        value = by;
        ++count;
    }
    return count;
}

}  // namespace

BrokenValues repair_values(Mesh& mesh) {
    BrokenValues broken;
    for (auto& uv : mesh.uv) broken.values += replace_broken(uv, V2f(0.f));
    for (auto& uv : mesh.more_uv) broken.values += replace_broken(uv, V2f(0.f));
    broken.values += replace_broken(mesh.colours, V4f(1.f));

    auto& positions = mesh.positions;
    const auto good = std::find_if(positions.begin(), positions.end(), is_finite<V3f>);
    if (std::find_if_not(positions.begin(), positions.end(), is_finite<V3f>) == positions.end())
        return broken;
    broken.triangles += std::erase_if(mesh.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](uint32_t vertex) { return !is_finite(positions[vertex]); });
    });
    // Vertices that no triangle has any more must not widen the bounds.
    const V3f inside = good == positions.end() ? V3f(0.f) : *good;
    for (V3f& position : positions)
        if (!is_finite(position)) position = inside;
    return broken;
}

bool add_missing_uv(Mesh& mesh, const Material& material) {
    bool added = false;
    for (const TextureSlot* slot : material.textures()) {
        if (!slot->present() || !mesh.uv_of(slot->uv_set).empty()) continue;
        mesh.uv_of(slot->uv_set).assign(mesh.positions.size(), V2f(0.f));
        added = true;
    }
    return added;
}

}  // namespace petzval::io
