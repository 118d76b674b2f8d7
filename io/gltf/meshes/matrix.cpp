// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/matrix.h"

namespace petzval {

double relative_determinant(const M44d& m) {
    const V3d x = row(m, 0), y = row(m, 1), z = row(m, 2);
    const double lengths = x.length() * y.length() * z.length();
    return lengths > 0 ? x.cross(y).dot(z) / lengths : 0;
}

}  // namespace petzval
