// SPDX-License-Identifier: Apache-2.0
// Rectangles with pixels around them.
#pragma once

#include <algorithm>

#include "core/film/film.h"

namespace petzval {

/// A rectangle with so many pixels more on each side, as far as `within` goes.
[[nodiscard]] inline Rect grown(const Rect& r, int by_px, const Rect& within) {
    return {std::max(r.x0 - by_px, within.x0), std::max(r.y0 - by_px, within.y0),
            std::min(r.x1 + by_px, within.x1), std::min(r.y1 + by_px, within.y1)};
}

}  // namespace petzval
