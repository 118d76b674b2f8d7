// SPDX-License-Identifier: Apache-2.0
// Letters, drawn with FreeType: OpenImageIO 2.4 draws no others than those of ASCII (its issue
// 3933).
#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <limits>
#include <memory>
#include <string_view>

#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/codec/codec.h"

namespace petzval::io::codec {
namespace {

/// A font opened for letters of one size.
class Font {
  public:
    Font(const std::filesystem::path& path, int letter_px) : path_(path) {
        FT_Library library = nullptr;
        require(FT_Init_FreeType(&library) == 0);
        library_.reset(library);
        FT_Face face = nullptr;
        require(FT_New_Face(library, path.c_str(), 0, &face) == 0);
        face_.reset(face);
        require(FT_Set_Pixel_Sizes(face, 0, FT_UInt(letter_px)) == 0);
    }

    /// Calls use(bitmap, x, y) for each letter: x and y are of its upper left corner, from the
    /// start of the base line.
    template <class Use>
    void draw(std::string_view utf8, const Use& use) const {
        FT_Pos pen = 0;  // in units of 1/64 pixel
        FT_UInt before = 0;
        while (!utf8.empty()) {
            const Character character = first_character(utf8);
            utf8.remove_prefix(std::max<size_t>(character.bytes, 1));
            const FT_UInt glyph =
                FT_Get_Char_Index(face_.get(), character.bytes == 0 ? 0xFFFD : character.code);
            FT_Vector closer{0, 0};
            FT_Get_Kerning(face_.get(), before, glyph, FT_KERNING_DEFAULT, &closer);
            require(FT_Load_Glyph(face_.get(), glyph, FT_LOAD_RENDER) == 0);
            const FT_GlyphSlot drawn = face_->glyph;
            require(drawn->bitmap.pixel_mode == FT_PIXEL_MODE_GRAY || drawn->bitmap.rows == 0);
            pen += closer.x;
            use(drawn->bitmap, int(pen / 64) + drawn->bitmap_left, -drawn->bitmap_top);
            pen += drawn->advance.x;
            before = glyph;
        }
    }

  private:
    void require(bool good) const {
        if (!good)
            throw InputError(path_.string(), "",
                             "cannot be used to draw letters; name a font such as the "
                             "DejaVuSans.ttf of Debian's package fonts-dejavu-core");
    }
    struct Close {
        void operator()(FT_Library library) const { FT_Done_FreeType(library); }
        void operator()(FT_Face face) const { FT_Done_Face(face); }
    };
    std::filesystem::path path_;
    std::unique_ptr<FT_LibraryRec_, Close> library_;
    std::unique_ptr<FT_FaceRec_, Close> face_;
};

}  // namespace

Picture draw_text(const std::string& utf8, int letter_px, const std::filesystem::path& path) {
    const Font font(path, letter_px);
    constexpr int kFar = std::numeric_limits<int>::max();
    int x0 = kFar, y0 = kFar, x1 = -kFar, y1 = -kFar;
    font.draw(utf8, [&](const FT_Bitmap& bitmap, int x, int y) {
        if (bitmap.width == 0 || bitmap.rows == 0) return;
        x0 = std::min(x0, x);
        y0 = std::min(y0, y);
        x1 = std::max(x1, x + int(bitmap.width));
        y1 = std::max(y1, y + int(bitmap.rows));
    });
    Picture letters;
    letters.channels = {"A"};
    if (x0 == kFar) return letters;

    letters.x = x0;
    letters.y = y0;
    letters.width = letters.full_width = x1 - x0;
    letters.height = letters.full_height = y1 - y0;
    letters.pixels.resize(size_t(letters.width) * size_t(letters.height));
    font.draw(utf8, [&](const FT_Bitmap& bitmap, int x, int y) {
        for (int row = 0; row < int(bitmap.rows); ++row)
            for (int column = 0; column < int(bitmap.width); ++column) {
                const size_t to =
                    size_t(y - y0 + row) * size_t(letters.width) + size_t(x - x0 + column);
                const float cover = float(bitmap.buffer[row * bitmap.pitch + column]) / 255.f;
                letters.pixels[to] = std::max(letters.pixels[to], cover);
            }
    });
    return letters;
}

}  // namespace petzval::io::codec
