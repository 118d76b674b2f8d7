// SPDX-License-Identifier: Apache-2.0
#include "io/picture/picture.h"

#include <algorithm>
#include <stdexcept>

namespace petzval::io {

PictureRows::PictureRows(const Picture& picture) : layout(picture) {
    const size_t row_size = size_t(picture.width) * picture.channels.size();
    if (picture.pixels.size() != row_size * size_t(picture.height))
        throw std::invalid_argument("a picture's pixels do not match its size and channels");
    row = [&picture, row_size](int y, float* out) {
        std::copy_n(picture.pixels.data() + size_t(y) * row_size, row_size, out);
    };
}

int channel_index(const PictureLayout& picture, std::string_view name) {
    const auto found = std::find(picture.channels.begin(), picture.channels.end(), name);
    return found == picture.channels.end() ? -1 : int(found - picture.channels.begin());
}

}  // namespace petzval::io
