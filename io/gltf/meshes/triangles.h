// SPDX-License-Identifier: Apache-2.0
// Vertex numbers of a glTF primitive as a list of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scene/mesh.h"

namespace petzval::io {

enum class TriangleMode { List, Strip, Fan };

/// Triangles of a primitive, wound as glTF 2.0, section 3.7.2.1 has it. Numbers left over after the
/// last whole triangle are dropped.
[[nodiscard]] std::vector<std::array<uint32_t, 3>> to_triangles(TriangleMode,
                                                                const std::vector<uint32_t>&);

/// Removes triangles without area (a repeated vertex, or corners on a line: their normal cannot be
/// told in float); returns how many there were.
size_t remove_zero_area(Mesh&);

}  // namespace petzval::io
