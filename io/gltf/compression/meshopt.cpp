// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>

#include "io/gltf/compression/meshopt_attributes.h"
#include "io/gltf/compression/meshopt_filters.h"

namespace petzval::io {
namespace {

// Of the extension's appendix A.
constexpr uint64_t kTail = 32;

/// The low four bits of a stream's first byte; the high four say the mode.
int version(uint8_t header) {
    return header & 0x0f;
}

/// The fewest bytes that `count` attributes take in version 0: two bits for each byte of 16
/// elements.
uint64_t least_attribute_bytes(uint64_t count, uint64_t stride) {
    const auto header = [](uint64_t elements) {
        return ((elements + kMeshoptGroup - 1) / kMeshoptGroup + 3) / 4;
    };
    const uint64_t block = attributes_in_block(stride);
    return 1 + stride * (count / block * header(block) + header(count % block)) +
           std::max(stride, kTail);
}

uint64_t least_bytes(const MeshoptLayout& layout, uint8_t header) {
    if (layout.mode == MeshoptMode::Attributes)
        return version(header) == 0 ? least_attribute_bytes(layout.count, layout.stride)
                                    : least_attribute_bytes_1(layout.count, layout.stride);
    return layout.mode == MeshoptMode::Triangles ? 1 + layout.count / 3 + kMeshoptGroup
                                                 : 1 + layout.count + 4;
}

std::string stride_fault(const MeshoptLayout& layout) {
    const uint64_t stride = layout.stride;
    if (layout.mode != MeshoptMode::Attributes)
        return stride == 2 || stride == 4 ? "" : "byteStride of indices must be 2 or 4";
    if (stride == 0 || stride % 4 != 0 || stride > 256)
        return "byteStride of attributes must be a multiple of 4 up to 256";
    const bool short_vectors =
        layout.filter == MeshoptFilter::Octahedral || layout.filter == MeshoptFilter::Color;
    if (short_vectors && stride != 4 && stride != 8)
        return "byteStride of the filters OCTAHEDRAL and COLOR must be 4 or 8";
    if (layout.filter == MeshoptFilter::Quaternion && stride != 8)
        return "byteStride of the filter QUATERNION must be 8";
    return "";
}

std::string header_fault(MeshoptMode mode, uint8_t header) {
    constexpr uint8_t kinds[] = {0xa0, 0xe0, 0xd0};
    if ((header & 0xf0) != kinds[static_cast<size_t>(mode)])
        return "the data are no stream of that mode";
    return version(header) <= 1
               ? ""
               : "the stream is of a newer version, which is not supported; export it without";
}

bool decode(const MeshoptLayout& layout, std::span<const uint8_t> stream, std::span<uint8_t> out) {
    const auto with = [&](int (*codec)(void*, size_t, size_t, const unsigned char*, size_t)) {
        return codec(out.data(), layout.count, layout.stride, stream.data(), stream.size()) == 0;
    };
    if (layout.mode == MeshoptMode::Attributes && version(stream[0]) == 1)
        return decode_attributes_1(stream, layout.stride, out);
    if (layout.mode == MeshoptMode::Attributes) return with(meshopt_decodeVertexBuffer);
    if (layout.mode == MeshoptMode::Triangles) return with(meshopt_decodeIndexBuffer);
    return with(meshopt_decodeIndexSequence);
}

void apply(MeshoptFilter filter, uint64_t stride, std::span<uint8_t> elements) {
    switch (filter) {
        case MeshoptFilter::Octahedral:
            return stride == 4 ? filter_octahedral_8(elements) : filter_octahedral_16(elements);
        case MeshoptFilter::Quaternion:
            return filter_quaternion(elements);
        case MeshoptFilter::Exponential:
            return filter_exponential(elements);
        case MeshoptFilter::Color:
            return stride == 4 ? filter_color_8(elements) : filter_color_16(elements);
        case MeshoptFilter::None:
            return;
    }
}

}  // namespace

std::string meshopt_fault(const MeshoptLayout& layout, std::span<const uint8_t> stream) {
    if (std::string fault = stride_fault(layout); !fault.empty()) return fault;
    if (layout.mode != MeshoptMode::Attributes && layout.filter != MeshoptFilter::None)
        return "filter must be NONE for indices";
    if (layout.mode == MeshoptMode::Triangles && layout.count % 3 != 0)
        return "count of indices of triangles must be a multiple of 3";
    if (stream.empty()) return "has no data";
    if (std::string fault = header_fault(layout.mode, stream[0]); !fault.empty()) return fault;
    return stream.size() < least_bytes(layout, stream[0])
               ? "the stream is too short for its count; the file is damaged"
               : "";
}

std::optional<std::vector<uint8_t>> decode_meshopt(const MeshoptLayout& layout,
                                                   std::span<const uint8_t> stream) {
    std::vector<uint8_t> out(layout.count * layout.stride);
    if (!decode(layout, stream, out)) return std::nullopt;
    apply(layout.filter, layout.stride, out);
    return out;
}

}  // namespace petzval::io
