// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/tiles.h"

#include <algorithm>

namespace petzval::integrator {
namespace {

// Position of cell (x, y) along the Hilbert curve over a square of `side` cells, a power of two.
// Hilbert 1891, by the usual recursion on quadrants.
uint64_t hilbert_index(uint32_t side, uint32_t x, uint32_t y) {
    uint64_t index = 0;
    for (uint32_t s = side / 2; s > 0; s /= 2) {
        const uint32_t right = (x & s) ? 1 : 0, lower = (y & s) ? 1 : 0;
        index += static_cast<uint64_t>(s) * s * ((3 * right) ^ lower);
        if (lower) continue;
        if (right) {
            x = (side - 1) ^ x;
            y = (side - 1) ^ y;
        }
        std::swap(x, y);
    }
    return index;
}

}  // namespace

std::vector<Rect> tiles_of(const Rect& crop, int size_px) {
    const int across = (crop.width() + size_px - 1) / size_px;
    const int down = (crop.height() + size_px - 1) / size_px;
    uint32_t side = 1;
    while (side < static_cast<uint32_t>(std::max(across, down))) side *= 2;
    std::vector<std::pair<uint64_t, Rect>> order;
    for (int j = 0; j < down; ++j) {
        for (int i = 0; i < across; ++i) {
            const int x0 = crop.x0 + i * size_px, y0 = crop.y0 + j * size_px;
            order.push_back(
                {hilbert_index(side, static_cast<uint32_t>(i), static_cast<uint32_t>(j)),
                 {x0, y0, std::min(x0 + size_px, crop.x1), std::min(y0 + size_px, crop.y1)}});
        }
    }
    std::sort(order.begin(), order.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Rect> tiles;
    for (const auto& [index, tile] : order) tiles.push_back(tile);
    return tiles;
}

}  // namespace petzval::integrator
