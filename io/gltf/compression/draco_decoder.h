// SPDX-License-Identifier: Apache-2.0
// Draco's decoder behind fences: it stops where a number in the stream would make it take more
// memory or time than is due.
#pragma once

#include "io/gltf/compression/draco_header.h"

namespace draco {
class Mesh;
}

namespace petzval::io {

/// Decodes a stream without metadata, whose header is without fault, into a mesh. Returns the
/// fault; nullptr where there is none. most_vertices: more are refused before their attributes are
/// decoded.
[[nodiscard]] const char* decode_draco_stream(std::span<const uint8_t> stream, const DracoHeader&,
                                              uint64_t most_vertices, draco::Mesh&);

}  // namespace petzval::io
