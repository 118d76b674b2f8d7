// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/matrix.h"

#include <algorithm>

namespace petzval::io {

double relative_determinant(const M44d& m) {
    const V3d x = row(m, 0), y = row(m, 1), z = row(m, 2);
    const double lengths = x.length() * y.length() * z.length();
    return lengths > 0 ? x.cross(y).dot(z) / lengths : 0;
}

double stretch(const M44d& m) {
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        double sum = 0;  // of a row of the matrix times its transpose: bounds its eigenvalues
        for (int j = 0; j < 3; ++j) sum += std::fabs(row(m, i).dot(row(m, j)));
        most = std::max(most, sum);
    }
    return std::sqrt(most);
}

M44d rotation_matrix(const std::array<double, 4>& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (norm == 0) return {};
    const double x = q[0] / norm, y = q[1] / norm, z = q[2] / norm, w = q[3] / norm;
    return {1 - 2 * (y * y + z * z),
            2 * (x * y + w * z),
            2 * (x * z - w * y),
            0,
            2 * (x * y - w * z),
            1 - 2 * (x * x + z * z),
            2 * (y * z + w * x),
            0,
            2 * (x * z + w * y),
            2 * (y * z - w * x),
            1 - 2 * (x * x + y * y),
            0,
            0,
            0,
            0,
            1};
}

}  // namespace petzval::io
