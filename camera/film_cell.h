// SPDX-License-Identifier: Apache-2.0
// Part of the film.
#pragma once

#include <algorithm>

#include "core/math/math.h"

namespace petzval::camera {

/// Rectangle of the film, from corner to corner, as FilmPoint has it.
struct FilmCell {
    V2f first, last;

    [[nodiscard]] float area() const { return (last.x - first.x) * (last.y - first.y); }
    /// The place of the cell that is nearest to another.
    [[nodiscard]] V2f nearest(V2f place) const {
        return {std::clamp(place.x, first.x, last.x), std::clamp(place.y, first.y, last.y)};
    }
};

}  // namespace petzval::camera
