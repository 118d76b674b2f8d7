// SPDX-License-Identifier: Apache-2.0
// Linear maps of a plane.
#pragma once

#include <cmath>

#include "core/math/math.h"

namespace petzval {

/// Linear map of a plane, by what it makes of the unit vectors.
struct Linear2f {
    V2f x{1, 0}, y{0, 1};

    [[nodiscard]] V2f operator()(V2f v) const { return x * v.x + y * v.y; }
    /// The map that does another one first.
    [[nodiscard]] Linear2f after(const Linear2f& first) const {
        return {(*this)(first.x), (*this)(first.y)};
    }
    [[nodiscard]] Linear2f operator*(float by) const { return {x * by, y * by}; }
    [[nodiscard]] Linear2f operator+(const Linear2f& o) const { return {x + o.x, y + o.y}; }
    [[nodiscard]] float determinant() const { return x.x * y.y - x.y * y.x; }
    /// Not finite where there is none.
    [[nodiscard]] Linear2f inverse() const {
        const float det = determinant();
        return {V2f(y.y, -x.y) / det, V2f(-y.x, x.x) / det};
    }
    /// Largest length of what a unit vector becomes: the larger singular value.
    [[nodiscard]] float most() const {
        const float sum = (x.length2() + y.length2()) / 2, det = determinant();
        return std::sqrt(sum + std::sqrt(std::fmax(0.f, sum * sum - det * det)));
    }
};

}  // namespace petzval
