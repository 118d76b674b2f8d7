// SPDX-License-Identifier: Apache-2.0
// Pixels that are rendered to learn something of a picture before it is rendered.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/math.h"

namespace petzval::integrator {

/// About so many pixels of a frame, a random one in each cell of an even grid, row by row. They
/// follow from size, number and seed alone.
[[nodiscard]] std::vector<std::array<int, 2>> pilot_pixels(V2i size_px, int wanted, uint32_t seed);

/// Pixels of the grid's cell that a pixel lies in: cells differ by a row and a column.
[[nodiscard]] int64_t pilot_cell_area_px(V2i size_px, int wanted, std::array<int, 2> pixel);

}  // namespace petzval::integrator
