// SPDX-License-Identifier: Apache-2.0
#include "io/image/canvas.h"

#include <algorithm>

namespace petzval::io {

Canvas::Canvas(int width, int height, const Colour8& ground)
    : width_(width), height_(height), pixels_(size_t(width) * size_t(height), ground) {}

void Canvas::fill(int x0, int y0, int width, int height, const Colour8& colour) {
    for (int y = y0; y < y0 + height; ++y)
        std::fill_n(pixels_.begin() + std::ptrdiff_t(at(x0, y)), width, colour);
}

void Canvas::put(const Picture8& picture, int x0, int y0) {
    const uint8_t* from = picture.rgb.data();
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x, from += 3)
            pixels_[at(x0 + x, y0 + y)] = {from[0], from[1], from[2]};
}

void Canvas::put_letters(const Picture& letters, int middle_x, int base_line_y,
                         const Colour8& colour) {
    const int x0 = middle_x - letters.width / 2, y0 = base_line_y + letters.y;
    for (int y = std::max(y0, 0); y < std::min(y0 + letters.height, height_); ++y)
        for (int x = std::max(x0, 0); x < std::min(x0 + letters.width, width_); ++x) {
            const float cover =
                letters.pixels[size_t(y - y0) * size_t(letters.width) + size_t(x - x0)];
            Colour8& pixel = pixels_[at(x, y)];
            for (size_t c = 0; c < pixel.size(); ++c)
                pixel[c] = static_cast<uint8_t>(cover * float(colour[c]) +
                                                (1.f - cover) * float(pixel[c]) + 0.5f);
        }
}

void Canvas::read(int y, float* row) const {
    for (int x = 0; x < width_; ++x)
        for (const uint8_t value : pixels_[at(x, y)]) *row++ = float(value) / 255.f;
}

}  // namespace petzval::io
