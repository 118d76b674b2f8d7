// SPDX-License-Identifier: Apache-2.0
// Options of ray traversal, without the code that traverses.
#pragma once

#include <cstdint>

namespace petzval {

/// Robust: no ray passes between neighbouring triangles. Fast: spatial splits and cheaper edge
/// tests, which may leak at edges and build longer.
enum class Traversal : uint8_t { Robust, Fast };

}  // namespace petzval
