// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/pilot_pixels.h"

#include <algorithm>
#include <cmath>

namespace petzval::integrator {
namespace {

// Number of cells that a side is cut into.
int parts(double wanted, int side_px) {
    return std::clamp(static_cast<int>(std::lround(wanted)), 1, side_px);
}

// Random pixel in one of the cells that a side is cut into.
int within(int cell, int cells, int side_px, uint32_t random) {
    const int64_t first = int64_t{cell} * side_px / cells;
    const int64_t end = int64_t{cell + 1} * side_px / cells;
    return static_cast<int>(first + ((int64_t{random} * (end - first)) >> 32));
}

/// Number of cells along both sides.
V2i cells_of(V2i size_px, int wanted) {
    const int nx = parts(std::sqrt(double(wanted) * size_px.x / size_px.y), size_px.x);
    return {nx, parts(double(wanted) / nx, size_px.y)};
}

/// Length of the cell that a pixel lies in.
int64_t length_px(int at, int cells, int side_px) {
    const int64_t cell = ((int64_t{at} + 1) * cells - 1) / side_px;
    return (cell + 1) * side_px / cells - cell * side_px / cells;
}

}  // namespace

int64_t pilot_cell_area_px(V2i size_px, int wanted, std::array<int, 2> pixel) {
    const V2i cells = cells_of(size_px, wanted);
    return length_px(pixel[0], cells.x, size_px.x) * length_px(pixel[1], cells.y, size_px.y);
}

std::vector<std::array<int, 2>> pilot_pixels(V2i size_px, int wanted, uint32_t seed) {
    const V2i cells = cells_of(size_px, wanted);
    const int nx = cells.x, ny = cells.y;
    std::vector<std::array<int, 2>> pixels;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            const uint32_t cell = hash32(seed, static_cast<uint32_t>(j * nx + i));
            pixels.push_back({within(i, nx, size_px.x, hash32(cell, 0)),
                              within(j, ny, size_px.y, hash32(cell, 1))});
        }
    return pixels;
}

}  // namespace petzval::integrator
