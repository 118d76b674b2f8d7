// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>

#include "io/gltf/compression/meshopt_filters.h"

namespace petzval {
namespace {

// The constants are those of the extension's appendix A.
constexpr uint64_t kBlockBytes = 8192, kBlockElements = 256, kGroup = 16, kTail = 32;

/// Elements of a whole block of attributes.
uint64_t block_elements(uint64_t stride) {
    return std::min(kBlockBytes / stride / kGroup * kGroup, kBlockElements);
}

/// The fewest bytes that `count` attributes take: two bits for each byte of 16 elements.
uint64_t least_attribute_bytes(uint64_t count, uint64_t stride) {
    const auto header = [](uint64_t elements) {
        return ((elements + kGroup - 1) / kGroup + 3) / 4;
    };
    const uint64_t block = block_elements(stride);
    return 1 + stride * (count / block * header(block) + header(count % block)) +
           std::max(stride, kTail);
}

uint64_t least_bytes(const MeshoptLayout& layout) {
    if (layout.mode == MeshoptMode::Attributes)
        return least_attribute_bytes(layout.count, layout.stride);
    return layout.mode == MeshoptMode::Triangles ? 1 + layout.count / 3 + kGroup
                                                 : 1 + layout.count + 4;
}

std::string stride_fault(const MeshoptLayout& layout) {
    const uint64_t stride = layout.stride;
    if (layout.mode != MeshoptMode::Attributes)
        return stride == 2 || stride == 4 ? "" : "byteStride of indices must be 2 or 4";
    if (stride == 0 || stride % 4 != 0 || stride > 256)
        return "byteStride of attributes must be a multiple of 4 up to 256";
    if (layout.filter == MeshoptFilter::Octahedral && stride != 4 && stride != 8)
        return "byteStride of the filter OCTAHEDRAL must be 4 or 8";
    if (layout.filter == MeshoptFilter::Quaternion && stride != 8)
        return "byteStride of the filter QUATERNION must be 8";
    return "";
}

/// The high four bits of the first byte say the mode, the low four the version.
std::string header_fault(MeshoptMode mode, uint8_t header) {
    constexpr uint8_t kinds[] = {0xa0, 0xe0, 0xd0}, versions[] = {0, 1, 1};
    const auto m = static_cast<size_t>(mode);
    if ((header & 0xf0) != kinds[m]) return "the data are no stream of that mode";
    return (header & 0x0f) <= versions[m]
               ? ""
               : "the stream is of a newer version, which is not supported; export it without";
}

bool decode(const MeshoptLayout& layout, std::span<const uint8_t> stream, void* out) {
    const auto with = [&](int (*codec)(void*, size_t, size_t, const unsigned char*, size_t)) {
        return codec(out, layout.count, layout.stride, stream.data(), stream.size()) == 0;
    };
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
    return stream.size() < least_bytes(layout)
               ? "the stream is too short for its count; the file is damaged"
               : "";
}

std::optional<std::vector<uint8_t>> decode_meshopt(const MeshoptLayout& layout,
                                                   std::span<const uint8_t> stream) {
    std::vector<uint8_t> out(layout.count * layout.stride);
    if (!decode(layout, stream, out.data())) return std::nullopt;
    apply(layout.filter, layout.stride, out);
    return out;
}

}  // namespace petzval
