// SPDX-License-Identifier: Apache-2.0
// Codec of KHR_draco_mesh_compression: bytes in, bytes out.
#pragma once

#include <vector>

#include "io/gltf/compression/draco_header.h"

namespace petzval::io {

/// An attribute of a stream, and what its values are to become.
struct DracoArray {
    uint32_t id = 0;         ///< the attribute's unique id
    int component_type = 0;  ///< of glTF: 5120 to 5126
    int components = 0;      ///< in an element, at most 4
};

struct DracoMesh {
    std::string fault;  ///< why there is none; empty where there is
    uint64_t vertices = 0;
    std::vector<uint8_t> indices;  ///< three numbers of 32 bits for each face, not yet checked
    std::vector<std::vector<uint8_t>> arrays;  ///< tightly packed, as asked for
};

/// Decodes a stream, whose header must be without fault, into the arrays asked for. Where it has
/// more vertices than most_vertices, it is refused before they take memory.
[[nodiscard]] DracoMesh decode_draco(std::span<const uint8_t> stream, const DracoHeader&,
                                     uint64_t most_vertices, std::span<const DracoArray>);

}  // namespace petzval::io
