// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/draco_mesh.h"

#include <draco/mesh/mesh.h>

#include <cstring>

#include "io/gltf/compression/draco_decoder.h"

namespace petzval::io {
namespace {

/// The stream without its metadata.
std::vector<uint8_t> without_metadata(std::span<const uint8_t> stream, const DracoHeader& header) {
    std::vector<uint8_t> bytes(stream.begin(), stream.begin() + kDracoHeaderBytes);
    bytes[kDracoHeaderBytes - 1] &= 0x7f;
    bytes.insert(bytes.end(), stream.begin() + ptrdiff_t(header.body), stream.end());
    return bytes;
}

template <class T>
bool convert(const draco::PointAttribute& from, uint64_t vertices, int components,
             std::vector<uint8_t>& to) {
    const size_t size = size_t(components) * sizeof(T);
    to.resize(vertices * size);
    T values[4];
    for (uint64_t i = 0; i < vertices; ++i) {
        const draco::PointIndex point(static_cast<uint32_t>(i));
        // It checks that the value lies in the attribute, and that it fits into a T.
        if (!from.ConvertValue(from.mapped_index(point), int8_t(components), values)) return false;
        std::memcpy(&to[i * size], values, size);
    }
    return true;
}

bool convert(const draco::PointAttribute& from, uint64_t vertices, const DracoArray& as,
             std::vector<uint8_t>& to) {
    switch (as.component_type) {
        case 5120:
            return convert<int8_t>(from, vertices, as.components, to);
        case 5121:
            return convert<uint8_t>(from, vertices, as.components, to);
        case 5122:
            return convert<int16_t>(from, vertices, as.components, to);
        case 5123:
            return convert<uint16_t>(from, vertices, as.components, to);
        case 5125:
            return convert<uint32_t>(from, vertices, as.components, to);
        default:
            return convert<float>(from, vertices, as.components, to);
    }
}

std::vector<uint8_t> indices_of(const draco::Mesh& mesh) {
    static_assert(sizeof(draco::Mesh::Face) == 3 * sizeof(uint32_t));
    std::vector<uint8_t> bytes(mesh.num_faces() * sizeof(draco::Mesh::Face));
    for (uint32_t i = 0; i < mesh.num_faces(); ++i)
        std::memcpy(&bytes[i * sizeof(draco::Mesh::Face)], &mesh.face(draco::FaceIndex(i)),
                    sizeof(draco::Mesh::Face));
    return bytes;
}

}  // namespace

DracoMesh decode_draco(std::span<const uint8_t> stream, const DracoHeader& header,
                       uint64_t most_vertices, std::span<const DracoArray> arrays) {
    DracoMesh out;
    draco::Mesh mesh;
    std::vector<uint8_t> stripped;
    if (header.body > kDracoHeaderBytes) stream = stripped = without_metadata(stream, header);
    if (const char* fault = decode_draco_stream(stream, header, most_vertices, mesh)) {
        out.fault = fault;
        return out;
    }
    out.vertices = mesh.num_points();
    for (const DracoArray& array : arrays) {
        const draco::PointAttribute* const from = mesh.GetAttributeByUniqueId(array.id);
        const bool there =
            from && from->num_components() == array.components &&
            (from->is_mapping_identity() || from->indices_map_size() >= out.vertices);
        out.arrays.emplace_back();
        if (there && convert(*from, out.vertices, array, out.arrays.back())) continue;
        out.fault = "its stream lacks the attribute " + std::to_string(array.id) +
                    " in the format of its accessor";
        return out;
    }
    out.indices = indices_of(mesh);
    return out;
}

}  // namespace petzval::io
