// SPDX-License-Identifier: Apache-2.0
#include "io/image/label.h"

#include <algorithm>

#include "io/image/picture_files.h"

namespace petzval::io {
namespace {

/// Size below which letters cannot be read: on a sheet of small cells, and of large ones, which are
/// looked at from further away.
int least_letter_px(int usual_px) {
    constexpr int kLeast_px = 9;
    return std::max(kLeast_px, usual_px / 2);
}

/// Places where a text may be cut: before each character but the first.
std::vector<size_t> cuts(const std::string& utf8) {
    std::vector<size_t> all;
    for (size_t i = 1; i < utf8.size(); ++i)
        if ((static_cast<uint8_t>(utf8[i]) & 0xC0) != 0x80) all.push_back(i);
    return all;
}

}  // namespace

int fitting_letters_px(const std::vector<std::string>& labels, int letter_px, int width_px,
                       const std::filesystem::path& font) {
    int widest_px = 0;
    for (const std::string& label : labels)
        widest_px = std::max(widest_px, draw_text(label, letter_px, font).width);
    if (widest_px <= width_px) return letter_px;
    return std::max(int(int64_t{letter_px} * width_px / widest_px), least_letter_px(letter_px));
}

Picture fitting_label(const std::string& utf8, int letter_px, int width_px,
                      const std::filesystem::path& font) {
    Picture letters = draw_text(utf8, letter_px, font);
    if (letters.width <= width_px) return letters;
    const auto cut_at = [&](size_t bytes) {
        return draw_text(utf8.substr(0, bytes) + "…", letter_px, font);
    };
    const std::vector<size_t> at = cuts(utf8);
    const auto beyond = std::partition_point(
        at.begin(), at.end(), [&](size_t bytes) { return cut_at(bytes).width <= width_px; });
    letters = cut_at(beyond == at.begin() ? 0 : *std::prev(beyond));
    // Not even the ellipsis has room.
    return letters.width <= width_px ? letters : draw_text("", letter_px, font);
}

}  // namespace petzval::io
