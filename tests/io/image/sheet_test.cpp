// SPDX-License-Identifier: Apache-2.0
#include "io/image/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "tests/support/pictures.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::noise;
using test::picture;
using test::TemporaryFolder;

// Of cells narrower than 260 pixels: letters of 12 pixels, one and a half of them below a picture.
constexpr int kGap = 12, kStrip = 18;

Picture plain(int width, int height, const Colour8& colour) {
    Picture p = picture(width, height, {"R", "G", "B"});
    for (size_t i = 0; i < p.pixels.size(); ++i) p.pixels[i] = float(colour[i % 3]) / 255.f;
    return p;
}

class Sheet : public ::testing::Test {
  protected:
    /// The sheet as it is written and read again.
    Picture written(const ContactSheet& sheet) const {
        sheet.write(folder_.path() / "sheet.png");
        return read_picture(folder_.path() / "sheet.png");
    }
    TemporaryFolder folder_;
};

Colour8 at(const Picture& sheet, int x, int y) {
    const size_t pixel = (size_t(y) * size_t(sheet.width) + size_t(x)) * 3;
    Colour8 colour{};
    for (size_t c = 0; c < 3; ++c)
        colour[c] = static_cast<uint8_t>(std::lround(sheet.pixels[pixel + c] * 255.f));
    return colour;
}

struct Box {
    int x, y, width, height;
    [[nodiscard]] bool holds(int px, int py) const {
        return px >= x && px < x + width && py >= y && py < y + height;
    }
};
void expect_colour(const Picture& sheet, const Box& box, const Colour8& colour) {
    for (int y = box.y; y < box.y + box.height; ++y)
        for (int x = box.x; x < box.x + box.width; ++x)
            ASSERT_EQ(at(sheet, x, y), colour) << x << ',' << y;
}
/// Pixels that are not of the ground: how many in the boxes, and how many outside of all of them.
struct Ink {
    std::vector<int> inside;
    int outside = 0;
};
Ink ink(const Picture& sheet, const std::vector<Box>& boxes) {
    Ink found{std::vector<int>(boxes.size()), 0};
    for (int y = 0; y < sheet.height; ++y)
        for (int x = 0; x < sheet.width; ++x) {
            if (at(sheet, x, y) == kSheetGround) continue;
            const auto box = std::find_if(boxes.begin(), boxes.end(),
                                          [&](const Box& b) { return b.holds(x, y); });
            ++(box == boxes.end() ? found.outside : found.inside[size_t(box - boxes.begin())]);
        }
    return found;
}

TEST_F(Sheet, PutsPicturesInRowsOnItsGround) {
    const std::vector<Colour8> colours{
        {255, 0, 0}, {0, 200, 0}, {0, 0, 90}, {7, 8, 9}, {255, 255, 255}};
    ContactSheet sheet(5, {.columns = 3});
    for (const Colour8& colour : colours) sheet.add(plain(40, 20, colour), "");
    const Picture p = written(sheet);
    EXPECT_EQ(p.width, 3 * 40 + 4 * kGap);
    EXPECT_EQ(p.height, 2 * (20 + kStrip) + 3 * kGap);
    std::vector<Box> boxes;
    for (int i = 0; i < 5; ++i) {
        boxes.push_back({kGap + i % 3 * 52, kGap + i / 3 * 50, 40, 20});
        expect_colour(p, boxes.back(), colours[size_t(i)]);
    }
    EXPECT_EQ(ink(p, boxes).outside, 0);
}

TEST_F(Sheet, PutsALabelUnderItsPictureAlone) {
    ContactSheet sheet(4, {.columns = 2});
    for (const char* label : {"f/1.4", "", "", "ƒ/2"})
        sheet.add(plain(60, 30, kSheetGround), label);
    const Picture p = written(sheet);
    const auto strip = [](int column, int row) {
        return Box{kGap + column * 72, kGap + 30 + row * 60, 60, kStrip};
    };
    const Ink found = ink(p, {strip(0, 0), strip(1, 0), strip(0, 1), strip(1, 1)});
    EXPECT_GT(found.inside[0], 20);
    EXPECT_EQ(found.inside[1], 0);
    EXPECT_EQ(found.inside[2], 0);
    EXPECT_GT(found.inside[3], 10);
    EXPECT_EQ(found.outside, 0);
    // In the middle, as light as letters are, and grey.
    int left = 60, right = -1;
    uint8_t lightest = 0;
    for (int x = 0; x < 60; ++x)
        for (int y = 0; y < kStrip; ++y) {
            const Colour8 colour = at(p, kGap + x, kGap + 30 + y);
            EXPECT_TRUE(colour[0] == colour[1] && colour[1] == colour[2]);
            lightest = std::max(lightest, colour[0]);
            if (colour == kSheetGround) continue;
            left = std::min(left, x);
            right = std::max(right, x);
        }
    EXPECT_NEAR(left + right, 59, 2);
    EXPECT_GT(lightest, 190);
    EXPECT_LE(lightest, kSheetLetters[0]);
}

TEST_F(Sheet, DrawsLongLabelsSmallerThenCutsThem) {
    const std::string lengthy = "Ångström, " + std::string(300, 'm');
    for (const char* label : {"a label wider", lengthy.c_str()}) {
        ContactSheet sheet(2, {.columns = 2});
        sheet.add(plain(70, 30, kSheetGround), "");
        sheet.add(plain(70, 30, kSheetGround), label);
        const Ink found = ink(written(sheet), {{kGap + 82, kGap + 30, 70, kStrip}});
        EXPECT_GT(found.inside[0], 50);
        EXPECT_EQ(found.outside, 0);
    }
}

TEST_F(Sheet, ShowsWhatALabelWouldHide) {
    ContactSheet sheet(1, {}), same(1, {});
    sheet.add(plain(200, 30, kSheetGround), "a\nb\xff");
    same.add(plain(200, 30, kSheetGround), "a\\u000ab\\xff");
    EXPECT_EQ(written(sheet).pixels, written(same).pixels);
}

TEST_F(Sheet, ReducesToItsCells) {
    ContactSheet sheet(2, {.columns = 2, .cell_width_px = 50});
    sheet.add(plain(500, 300, {10, 20, 30}), "");
    sheet.add(plain(20, 10, {200, 100, 50}), "");  // not enlarged: in the middle, on its label
    const Picture p = written(sheet);
    EXPECT_EQ(p.width, 2 * 50 + 3 * kGap);
    EXPECT_EQ(p.height, 30 + kStrip + 2 * kGap);
    const std::vector<Box> boxes{{kGap, kGap, 50, 30}, {kGap + 62 + 15, kGap + 20, 20, 10}};
    expect_colour(p, boxes[0], {10, 20, 30});
    expect_colour(p, boxes[1], {200, 100, 50});
    EXPECT_EQ(ink(p, boxes).outside, 0);
}

TEST_F(Sheet, IsNotWiderThanAScreenUnasked) {
    ContactSheet sheet(2, {.columns = 2});
    sheet.add(plain(4000, 40, {1, 2, 3}), "");
    sheet.add(plain(4000, 40, {1, 2, 3}), "");
    const Picture p = written(sheet);
    EXPECT_EQ(p.width, 3840);  // cells of 1902 pixels, 19 high, and letters of 40 pixels
    EXPECT_EQ(p.height, 19 + 60 + 2 * kGap);
}

TEST_F(Sheet, IsAboutSquareUnasked) {
    const auto columns = [](size_t pictures, int width, int height) {
        return sheet_layout(pictures, {}, width, height).columns;
    };
    EXPECT_EQ(columns(1, 100, 100), 1);
    EXPECT_EQ(columns(4, 100, 100), 2);
    EXPECT_EQ(columns(9, 1000, 1000), 3);
    EXPECT_EQ(columns(3, 900, 200), 1);
    EXPECT_EQ(columns(3, 200, 900), 3);
    EXPECT_EQ(sheet_layout(9, {.columns = 20}, 100, 100).columns, 9);
}

TEST_F(Sheet, SaysThatAPictureIsMissing) {
    ContactSheet sheet(3, {.columns = 3});
    sheet.add_missing("");
    sheet.add(plain(90, 40, {255, 0, 0}), "");
    sheet.add_missing("f/2");
    const Picture p = written(sheet);
    EXPECT_EQ(p.width, 3 * 90 + 4 * kGap);
    EXPECT_EQ(p.height, 40 + kStrip + 2 * kGap);
    const std::vector<Box> boxes{{kGap, kGap, 90, 40},
                                 {kGap + 102, kGap, 90, 40},
                                 {kGap + 204, kGap, 90, 40},
                                 {kGap + 204, kGap + 40, 90, kStrip}};
    const Ink found = ink(p, boxes);
    EXPECT_EQ(found.inside[0], 90 * 40);
    EXPECT_EQ(found.outside, 0);
    EXPECT_GT(found.inside[3], 10);
    expect_colour(p, boxes[1], {255, 0, 0});
    for (const size_t i : {0, 2}) {
        int word = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 90; ++x)
                word += at(p, boxes[i].x + x, boxes[i].y + y) != kSheetMissing ? 1 : 0;
        EXPECT_GT(word, 50);
        EXPECT_LT(word, 90 * 12);
    }
}

TEST_F(Sheet, IsWrittenWithWhatThereIs) {
    ContactSheet none(6, {.columns = 3});
    none.add_missing("all there is");
    EXPECT_EQ(written(none).width, 3 * 240 + 4 * kGap);
    ContactSheet some(6, {.columns = 3});
    for (int i = 0; i < 2; ++i) some.add(plain(30, 20, {9, 9, 9}), "");
    const Picture p = written(some);
    EXPECT_EQ(p.width, 3 * 30 + 4 * kGap);
    EXPECT_EQ(p.height, 20 + kStrip + 2 * kGap);
}

TEST_F(Sheet, RefusesWhatItCannotDo) {
    EXPECT_THROW(ContactSheet(0), std::invalid_argument);
    ContactSheet one(1);
    EXPECT_THROW(one.write(folder_.path() / "empty.png"), std::invalid_argument);
    one.add_missing("");
    EXPECT_THROW(one.add_missing(""), std::invalid_argument);
    const std::string wide =
        refusal([] { ContactSheet(60, {.columns = 60, .cell_width_px = 1200}).expect(1200, 10); });
    EXPECT_TRUE(has(wide, "72732x")) << wide;
    EXPECT_TRUE(has(wide, "65535 on a side at most; take smaller pictures, or fewer"));
    EXPECT_TRUE(has(refusal([] { ContactSheet(40, {.columns = 1}).expect(1000, 2000); }), "x8"));
    ContactSheet(50, {.columns = 50, .cell_width_px = 1200}).expect(1200, 10);

    // 65460 pixels and what is around them: 65502, which a PNG may have.
    ContactSheet high(1);
    high.add(plain(2, 65460, {1, 2, 3}), "");
    const auto png = folder_.path() / "high.png";
    high.write(png);
    const std::vector<uint8_t> bytes = test::read_bytes(png);  // too high to be read as a picture
    EXPECT_EQ(std::vector<uint8_t>(bytes.begin() + 20, bytes.begin() + 24),
              (std::vector<uint8_t>{0, 0, 0xFF, 0xDE}));
    const auto jpeg = folder_.path() / "high.jpg";
    EXPECT_TRUE(
        has(refusal([&] { high.write(jpeg); }), jpeg.string() + ": would be 40x65502 pixels"));
    ContactSheet higher(1);
    higher.add(plain(2, 65500, {1, 2, 3}), "");
    EXPECT_TRUE(has(refusal([&] { higher.write(folder_.path() / "higher.png"); }), "40x65542"));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "higher.png"));
}

TEST_F(Sheet, IsCheckedEarly) {
    const auto complaint = [&](const std::filesystem::path& path, const SheetOptions& o = {}) {
        return refusal([&] { check_sheet(path, o); });
    };
    const auto png = folder_.path() / "sheet.png", other = folder_.path() / "other.ttf";
    check_sheet(png, {});
    EXPECT_FALSE(std::filesystem::exists(png));
    EXPECT_TRUE(has(complaint(folder_.path() / "a.exr"), "is written as .png, .jpg or .jpeg"));
    EXPECT_TRUE(has(complaint(folder_.path() / "none" / "a.png"), "none"));
    EXPECT_TRUE(has(complaint(png, {.font = other}), other.string() + ": is not there"));
    EXPECT_TRUE(has(complaint(png, {.font = other}), "install Debian's package fonts-dejavu-core"));
    std::ofstream(other) << "no font";
    EXPECT_TRUE(
        has(complaint(png, {.font = other}), other.string() + ": cannot be used to draw letters"));
}

}  // namespace
}  // namespace petzval::io
