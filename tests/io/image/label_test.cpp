// SPDX-License-Identifier: Apache-2.0
#include "io/image/label.h"

#include <gtest/gtest.h>

#include "io/image/picture_files.h"
#include "io/image/sheet_layout.h"

namespace petzval::io {
namespace {

const std::filesystem::path kFont = SheetOptions{}.font;

Picture letters(const std::string& text, int letter_px = 40) {
    return draw_text(text, letter_px, kFont);
}

TEST(DrawText, StandsOnItsBaseLine) {
    const Picture x = letters("x"), g = letters("g"), i = letters("ï");
    EXPECT_EQ(x.channels, std::vector<std::string>{"A"});
    EXPECT_EQ(x.y + x.height, 0);
    EXPECT_NEAR(g.y, x.y, 1) << "as high as an x";
    EXPECT_GT(g.y + g.height, 5);
    EXPECT_LT(i.y, x.y - 4);
    // DejaVu Sans: an x is 1120 of 2048 units high.
    EXPECT_NEAR(x.height, 40 * 1120. / 2048, 1.);
    EXPECT_NEAR(letters("x", 20).height, 20 * 1120. / 2048, 1.);
}

TEST(DrawText, CoversFromNothingToAll) {
    const Picture p = letters("■");
    float least = 1, most = 0;
    for (const float value : letters("f/1.4").pixels) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    EXPECT_EQ(least, 0.f);
    EXPECT_EQ(most, 1.f);
    EXPECT_EQ(p.pixels[p.pixels.size() / 2], 1.f);
}

TEST(DrawText, DrawsEachCharacterOfUtf8) {
    // Characters of 2, 3 and 4 bytes, which OpenImageIO would take for "6", "&" and the like.
    const Picture box = letters("\uE000"), missing = letters("日");
    EXPECT_EQ(missing.pixels, box.pixels);
    for (const char* text : {"ö", "…", "ƒ", "Å", "Ж", "😀"})
        EXPECT_NE(letters(text).pixels, box.pixels) << text;
    EXPECT_NE(letters("ö").pixels, letters("6").pixels);
    EXPECT_NE(letters("ö").pixels, letters("o").pixels);
    // Its letter is the same: the rows of an o.
    const Picture o = letters("o"), umlaut = letters("ö");
    ASSERT_EQ(umlaut.width, o.width);
    EXPECT_EQ(std::vector<float>(umlaut.pixels.end() - long(o.pixels.size()), umlaut.pixels.end()),
              o.pixels);
    EXPECT_EQ(letters("a\xff").pixels, letters("a\uFFFD").pixels);
}

TEST(DrawText, SetsLettersBesideEachOther) {
    EXPECT_GT(letters("mm").width, 2 * letters("m").width - 1);
    EXPECT_GT(letters("m m").width, letters("mm").width + 5);
    EXPECT_LT(letters("AV").width, letters("A").width + letters("V").width) << "kerning";
    for (const char* nothing : {"", "   "}) {
        EXPECT_EQ(letters(nothing).width, 0);
        EXPECT_TRUE(letters(nothing).pixels.empty());
    }
}

TEST(FittingLabel, IsWholeWhereItFits) {
    const int width = letters("f/1.4", 12).width;
    EXPECT_EQ(fitting_label("f/1.4", 12, width, kFont).pixels, letters("f/1.4", 12).pixels);
    EXPECT_EQ(fitting_label("f/1.4", 12, width - 1, kFont).pixels, letters("f/…", 12).pixels);
}

TEST(FittingLabel, IsCutBetweenCharacters) {
    std::string text;
    std::vector<Picture> cuts;
    for (int i = 0; i < 30; ++i, text += "ö") cuts.push_back(letters(text + "…", 12));
    for (int width = cuts.front().width; width < 150; ++width) {
        size_t longest = 0;
        while (cuts[longest + 1].width <= width) ++longest;
        EXPECT_EQ(fitting_label(text, 12, width, kFont).pixels, cuts[longest].pixels) << width;
    }
    EXPECT_EQ(fitting_label(text, 12, 2, kFont).width, 0);
}

TEST(FittingLetters, AreSmallerForALongLabelDownToWhatCanBeRead) {
    const std::string label = "a label of some length";
    const int width = letters(label, 24).width;
    EXPECT_EQ(fitting_letters_px({"a", label}, 24, width, kFont), 24);
    const int fitting = fitting_letters_px({"a", label, "b"}, 24, width * 3 / 4, kFont);
    EXPECT_NEAR(fitting, 18, 1);
    EXPECT_LE(letters(label, fitting).width, width * 3 / 4);
    EXPECT_EQ(fitting_letters_px({label}, 24, width / 10, kFont), 12);
    EXPECT_EQ(fitting_letters_px({label}, 12, 10, kFont), 9);
    EXPECT_EQ(fitting_letters_px({}, 12, 10, kFont), 12);
}

}  // namespace
}  // namespace petzval::io
