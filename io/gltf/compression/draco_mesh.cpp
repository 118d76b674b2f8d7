// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/draco_mesh.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>

#include <cstring>
#include <stdexcept>

namespace petzval {
namespace {

constexpr const char* kDamaged = "its stream cannot be decoded; the file is damaged";

/// A decoder of Draco's that stops before the attributes take memory where there is no need for so
/// much: an attribute may have 255 components, and a stream any number of attributes.
template <class Decoder>
class Fenced : public Decoder {
  public:
    Fenced(uint64_t vertices, uint64_t limit) : vertices_(vertices), limit_(limit) {}

    [[nodiscard]] const char* fault() const { return fault_; }

  private:
    bool DecodeAllAttributes() override {
        const draco::PointCloud& cloud = *this->point_cloud();
        if (cloud.num_points() != vertices_)
            fault_ = "its stream has another number of vertices than its accessors";
        else if (attribute_bytes(cloud) > limit_)
            fault_ = "its stream is far too short for its attributes; the file is damaged";
        return !fault_ && Decoder::DecodeAllAttributes();
    }

    /// What decoding takes: the values, as integers too, and where each vertex finds its own.
    uint64_t attribute_bytes(const draco::PointCloud& cloud) const {
        uint64_t bytes = 0;
        for (int i = 0; i < cloud.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *cloud.attribute(i);
            bytes += vertices_ *
                     (uint64_t(attribute.byte_stride()) + 4u * attribute.num_components() + 8);
        }
        return bytes;
    }

    uint64_t vertices_, limit_;
    const char* fault_ = nullptr;
};

/// The stream without its metadata.
std::vector<uint8_t> without_metadata(std::span<const uint8_t> stream, const DracoHeader& header) {
    std::vector<uint8_t> bytes(stream.begin(), stream.begin() + kDracoHeaderBytes);
    bytes[kDracoHeaderBytes - 1] &= 0x7f;
    bytes.insert(bytes.end(), stream.begin() + ptrdiff_t(header.body), stream.end());
    return bytes;
}

/// Decodes into mesh; the fault, or nullptr.
template <class Decoder>
const char* decode(std::span<const uint8_t> stream, uint64_t vertices, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    const draco::DecoderOptions options;
    Fenced<Decoder> decoder(vertices, draco_memory_limit(stream.size()));
    try {
        if (decoder.Decode(options, &buffer, &mesh).ok()) return nullptr;
    } catch (const std::length_error&) {  // a number from the stream that no vector can have
    }
    return decoder.fault() ? decoder.fault() : kDamaged;
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
                       uint64_t vertices, std::span<const DracoArray> arrays) {
    DracoMesh out;
    draco::Mesh mesh;
    std::vector<uint8_t> stripped;
    if (stream[kDracoHeaderBytes - 1] & 0x80) stream = stripped = without_metadata(stream, header);
    const char* const fault = header.connectivity == DracoConnectivity::Edgebreaker
                                  ? decode<draco::MeshEdgebreakerDecoder>(stream, vertices, mesh)
                                  : decode<draco::MeshSequentialDecoder>(stream, vertices, mesh);
    if (fault || mesh.num_faces() != header.faces) {
        out.fault = fault ? fault : kDamaged;
        return out;
    }
    for (const DracoArray& array : arrays) {
        const draco::PointAttribute* const from = mesh.GetAttributeByUniqueId(array.id);
        const bool there = from && from->num_components() == array.components &&
                           (from->is_mapping_identity() || from->indices_map_size() >= vertices);
        out.arrays.emplace_back();
        if (there && convert(*from, vertices, array, out.arrays.back())) continue;
        out.fault = "its stream lacks the attribute " + std::to_string(array.id) +
                    " in the format of its accessor";
        return out;
    }
    out.indices = indices_of(mesh);
    return out;
}

}  // namespace petzval
