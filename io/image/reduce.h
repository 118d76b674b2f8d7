// SPDX-License-Identifier: Apache-2.0
// Display pictures made smaller.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/picture/picture.h"

namespace petzval::io {

using Colour8 = std::array<uint8_t, 3>;  ///< R, G, B as an sRGB display takes them

/// Display picture of 8 bits a channel: R, G, B, row 0 at the top.
struct Picture8 {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

/// Display picture over a ground and reduced to a size that is nowhere larger. Each pixel is the
/// mean over the area that it covers, in linear light (by the curve of sRGB), so that a fine
/// pattern keeps its brightness. display: channels R, G, B and perhaps A, unassociated, in [0, 1].
/// Its rows are asked for in turn and not kept.
[[nodiscard]] Picture8 reduced(const PictureRows& display, int width, int height,
                               const Colour8& ground);

}  // namespace petzval::io
