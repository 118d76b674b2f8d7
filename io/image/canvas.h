// SPDX-License-Identifier: Apache-2.0
// 8-bit picture that others and letters are put on.
#pragma once

#include <cstddef>
#include <vector>

#include "io/image/reduce.h"
#include "io/picture/picture.h"

namespace petzval::io {

class Canvas {
  public:
    /// Canvas of one colour.
    Canvas(int width, int height, const Colour8& ground);

    /// Fills a rectangle, which lies inside.
    void fill(int x0, int y0, int width, int height, const Colour8&);
    /// Puts a picture at a place where it has room.
    void put(const Picture8&, int x0, int y0);
    /// Puts letters, as draw_text() has them, around middle_x; what has no room is left out.
    void put_letters(const Picture& letters, int middle_x, int base_line_y, const Colour8&);
    /// Gives row y: R, G, B in [0, 1].
    void read(int y, float* row) const;

  private:
    [[nodiscard]] size_t at(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }

    int width_, height_;
    std::vector<Colour8> pixels_;
};

}  // namespace petzval::io
