// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/scene/mesh.h"

namespace petzval {

/// Triangles of a geodesic sphere: those of an icosahedron, parted in four `halvings` times.
[[nodiscard]] constexpr size_t geodesic_triangles(int halvings) {
    return size_t{20} << (2 * halvings);
}

/// A geodesic sphere of radius 1 about the origin, its fronts outwards: an icosahedron whose edges
/// are halved again and again, every corner on the sphere. It has positions and triangles alone.
[[nodiscard]] Mesh geodesic_sphere(int halvings);

}  // namespace petzval
