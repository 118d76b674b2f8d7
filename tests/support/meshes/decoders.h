// SPDX-License-Identifier: Apache-2.0
// The codecs of meshes without a glTF file around them, for the fuzzer.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "io/gltf/compression/draco_mesh.h"
#include "io/gltf/compression/meshopt.h"

namespace petzval::test {

/// Whether bytes are a Draco stream of positions, normals, texture coordinates and colours: the
/// greatest number of vertices in 16 bits, then the stream.
inline bool decodes_draco(std::span<const uint8_t> bytes) {
    if (bytes.size() < 2) return false;
    const uint64_t vertices = bytes[0] | bytes[1] << 8;
    const auto stream = bytes.subspan(2);
    const io::DracoHeader header = io::read_draco_header(stream);
    if (!header.fault.empty()) return false;
    const std::array<io::DracoArray, 4> all = {
        {{0, 5126, 3}, {1, 5126, 3}, {2, 5126, 2}, {3, 5121, 4}}};
    return io::decode_draco(stream, header, vertices, all).fault.empty();
}

/// Whether bytes are a meshopt stream: mode in two bits and filter in three, the stride, the count
/// in 16 bits, then the stream.
inline bool decodes_meshopt(std::span<const uint8_t> bytes) {
    if (bytes.size() < 4 || (bytes[0] & 3) > 2 || (bytes[0] >> 2 & 7) > 4) return false;
    const io::MeshoptLayout layout{static_cast<io::MeshoptMode>(bytes[0] & 3),
                                   static_cast<io::MeshoptFilter>(bytes[0] >> 2 & 7),
                                   uint64_t(bytes[2] | bytes[3] << 8), bytes[1]};
    const auto stream = bytes.subspan(4);
    if (!io::meshopt_fault(layout, stream).empty()) return false;
    const auto decoded = io::decode_meshopt(layout, stream);
    if (decoded && decoded->size() > 1024 * stream.size())
        throw std::logic_error("a stream is decoded to more than its bound");
    return decoded.has_value();
}

}  // namespace petzval::test
