// SPDX-License-Identifier: Apache-2.0
// petzval image sheet and petzval image crop.
#include <cmath>

#include "tests/support/cli.h"
#include "tests/support/pictures.h"
#include "tests/support/tiny_png.h"

namespace petzval {
namespace {

using test::noise;
using test::picture;

class CliImageEdit : public CliTest {
  protected:
    std::string exr(const std::string& name, const Picture& p) const {
        write_exr(path(name), p);
        return path(name);
    }
    std::string png(const std::string& name, const Picture& p) const {
        write_8bit(path(name), p);
        return path(name);
    }
    static Picture plain(float r, float g, float b) {
        Picture p = picture(30, 20, {"R", "G", "B"});
        for (size_t i = 0; i < p.pixels.size(); i += 3) {
            p.pixels[i] = r;
            p.pixels[i + 1] = g;
            p.pixels[i + 2] = b;
        }
        return p;
    }
    /// Runs a command that must succeed; what it says.
    static std::string run(const Words& words) {
        const Finished done = run_petzval(words);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        EXPECT_EQ(done.out, "");
        return done.err;
    }
    Picture sheet(Words words) {
        words.insert(words.begin(), {"image", "sheet"});
        words.insert(words.end(), {"-o", path("sheet.png")});
        EXPECT_EQ(run(words), "");
        return read_picture(path("sheet.png"));
    }
    /// Red in the middle of a cell of 30x20 pixels, 0 to 255.
    static int red(const Picture& p, int column, int row = 0) {
        return int(std::lround(255 * value_at(p, 12 + column * 42 + 15, 12 + row * 50 + 10, "R")));
    }
};

TEST_F(CliImageEdit, SheetShowsLightThroughTheViewAndOthersAsTheyAre) {
    const std::string light = exr("light.exr", plain(0.5f, 0.5f, 0.5f));
    const std::string shown = png("shown.png", plain(100 / 255.f, 0, 0));
    write_bytes(path("grey.png"), tiny_png(1, 1, 8, PngColour::Grey, {{77}}));
    const Words files{light, shown, path("grey.png"), "--columns", "3"};
    const auto with = [&](const Words& more) {
        Words words = files;
        words.insert(words.end(), more.begin(), more.end());
        return sheet(words);
    };
    const Picture p = with({});
    EXPECT_EQ(p.width, 3 * 30 + 4 * 12);
    EXPECT_EQ(p.height, 20 + 18 + 2 * 12);
    // IEC 61966-2-1: 1.055 * 0.5^(1 / 2.4) - 0.055 is 0.7354, 187.5 of 255.
    EXPECT_NEAR(red(p, 0), 187.5, 0.5);
    EXPECT_EQ(red(p, 1), 100);
    EXPECT_NEAR(value_at(p, 12 + 84 + 14, 12 + 19, "G"), 77 / 255.f, 1e-5);  // stands on its label
    const Picture brighter = with({"--exposure", "1"});
    EXPECT_EQ(red(brighter, 0), 255);
    EXPECT_EQ(red(brighter, 1), 100);
    EXPECT_NEAR(red(with({"--view", "raw"}), 0), 127.5, 0.6);
}

TEST_F(CliImageEdit, SheetFindsOneExposureForAll) {
    const std::string a = exr("a.exr", plain(40, 40, 40)), b = exr("b.exr", plain(10, 10, 10));
    Words words{"image",      "sheet", a,        b,     "--columns", "2",
                "--exposure", "auto",  "--view", "raw", "-o",        path("s.png")};
    const std::string told = run(words);
    EXPECT_TRUE(told.starts_with("petzval: exposure: ")) << told;
    EXPECT_EQ(told.find('\n'), told.size() - 1) << told;
    const Picture p = read_picture(path("s.png"));
    EXPECT_GT(red(p, 0), 20);
    EXPECT_NEAR(red(p, 1), red(p, 0) / 4., 1.);
}

TEST_F(CliImageEdit, SheetLabelsWithTheNamesOfTheFilesOrAsTold) {
    const std::string a = png("first one.png", plain(0, 0, 0)), b = png("b.png", plain(1, 0, 0));
    const Picture usual = sheet({a, b, "--columns", "2"});
    EXPECT_EQ(sheet({a, b, "--columns", "2", "--labels", "first one; b"}).pixels, usual.pixels);
    EXPECT_NE(sheet({a, b, "--columns", "2", "--labels", "b;first one"}).pixels, usual.pixels);
    EXPECT_NE(sheet({a, b, "--columns", "2", "--labels", ";"}).pixels, usual.pixels);
    EXPECT_EQ(red(usual, 0), 0);
    EXPECT_EQ(red(usual, 1), 255);
    const Picture high = sheet({a, b, "--columns", "1"});
    EXPECT_EQ(high.width, 30 + 2 * 12);
    EXPECT_EQ(red(high, 0, 1), 255);
    const Picture small = sheet({a, b, "--columns", "2", "--cell", "20"});
    EXPECT_EQ(small.width, 2 * 20 + 3 * 12);
    EXPECT_EQ(small.height, 13 + 18 + 2 * 12);
}

TEST_F(CliImageEdit, SheetRefuses) {
    const std::string a = png("a.png", plain(0, 0, 0)),
                      e = exr("e.exr", picture(2, 2, {"depth.Z"}));
    const auto error = [&](Words words, int exit_code) {
        words.insert(words.begin(), {"image", "sheet"});
        return error_of(words, exit_code);
    };
    const std::string out = path("out.png");
    EXPECT_NE(error({"-o", out}, 2).find("pictures is required"), std::string::npos);
    EXPECT_NE(error({a, a, "-o", out, "--labels", "one"}, 2)
                  .find("--labels: 1 for 2 pictures; give one label for each"),
              std::string::npos);
    EXPECT_NE(error({a, "-o", out, "--labels", "one;two"}, 2).find("2 for 1 pictures"),
              std::string::npos);
    EXPECT_NE(error({a, "-o", path("out.exr")}, 2).find("a view is written as .png"),
              std::string::npos);
    EXPECT_NE(error({a, "-o", out, "--columns", "0"}, 2).find("--columns"), std::string::npos);
    EXPECT_NE(error({a, "-o", out, "--cell", "3"}, 2).find("--cell"), std::string::npos);
    EXPECT_NE(error({a, "-o", out, "--exposure", "much"}, 2).find("--exposure"), std::string::npos);
    EXPECT_NE(error({a, path("none.png"), "-o", out}, 1).find("none.png"), std::string::npos);
    EXPECT_NE(error({e, "-o", out}, 1).find("e.exr: has no channels R, G and B"),
              std::string::npos);
    EXPECT_NE(error({e, a, "-o", a}, 2).find("-o would overwrite a picture of the sheet"),
              std::string::npos);
    EXPECT_NE(error({a, "-o", path("no/out.png")}, 3).find("no"), std::string::npos);
    EXPECT_NE(error({a, "-o", out, "--max-memory", "1kB"}, 1).find("a.png"), std::string::npos);
}

// A picture of a part of a frame of 40x30 pixels, with more than colours.
Picture part() {
    Picture p = noise(20, 15, {"R", "G", "B", "A", "depth.Z"});
    p.x = 5;
    p.y = 10;
    p.full_width = 40;
    p.full_height = 30;
    p.metadata = {
        {"petzval:lens", std::string("a lens")}, {"petzval:spp", 64}, {"petzval:fov_deg", 27.5f}};
    return p;
}

TEST_F(CliImageEdit, CropKeepsLayersFrameAndMetadata) {
    const std::string in = exr("in.exr", part());
    EXPECT_EQ(run({"image", "crop", in, "7,12,4,3", "-o", path("cut.exr")}), "");
    const Picture whole = read_picture(in), cut = read_picture(path("cut.exr"));
    EXPECT_EQ(cut.channels, whole.channels);
    EXPECT_EQ(cut.metadata, whole.metadata);
    EXPECT_EQ(metadata_of(cut, "petzval:lens"), "a lens");
    EXPECT_EQ(
        (std::vector<int>{cut.x, cut.y, cut.width, cut.height, cut.full_width, cut.full_height}),
        (std::vector<int>{7, 12, 4, 3, 40, 30}));
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (const std::string& channel : cut.channels)
                EXPECT_EQ(value_at(cut, x, y, channel), value_at(whole, x + 2, y + 2, channel));
    // By the frame's coordinates again; and all that there is gives the same file.
    EXPECT_EQ(run({"image", "crop", path("cut.exr"), "9,13,1,1", "-o", path("one.exr")}), "");
    EXPECT_EQ(read_picture(path("one.exr")).pixels[0], value_at(whole, 4, 3, "R"));
    EXPECT_EQ(run({"image", "crop", in, "5,10,20,15", "-o", path("all.exr")}), "");
    EXPECT_EQ(file_bytes(path("all.exr")), file_bytes(in));
}

TEST_F(CliImageEdit, CropOfLightIsShownAsTheWholeIs) {
    Picture in = part();
    for (size_t i = 0; i < in.pixels.size(); i += 5)
        in.pixels[i] *= float(i);  // brighter downwards
    const std::string file = exr("in.exr", in);
    for (const Words& view :
         {Words{}, Words{"--view", "ACES", "--exposure", "-2"}, Words{"--exposure", "auto"}}) {
        Words whole{"image", "view", file, "-o", path("whole.png")};
        Words cut{"image", "crop", file, "6,11,5,2", "-o", path("cut.png")};
        whole.insert(whole.end(), view.begin(), view.end());
        cut.insert(cut.end(), view.begin(), view.end());
        EXPECT_EQ(run(cut), run(whole));  // the exposure that was found
        const Picture a = read_picture(path("whole.png")), b = read_picture(path("cut.png"));
        ASSERT_EQ(b.width, 5);
        ASSERT_EQ(b.height, 2);
        ASSERT_EQ(b.channels, a.channels);
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 5; ++x)
                for (const std::string& channel : b.channels)
                    EXPECT_EQ(value_at(b, x, y, channel), value_at(a, x + 1, y + 1, channel));
    }
}

TEST_F(CliImageEdit, CropOfPngIsAsItWas) {
    const std::string in = png("in.png", noise(9, 8, {"R", "G", "B", "A"}));
    EXPECT_EQ(run({"image", "crop", in, "2,3,4,5", "-o", path("cut.png")}), "");
    const Picture whole = read_picture(in), cut = read_picture(path("cut.png"));
    ASSERT_EQ((std::array{cut.width, cut.height}), (std::array{4, 5}));
    ASSERT_EQ(cut.channels, whole.channels);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 4; ++x)
            for (const std::string& channel : cut.channels)
                EXPECT_EQ(value_at(cut, x, y, channel), value_at(whole, x + 2, y + 3, channel));
    const std::string opaque = png("opaque.png", plain(1, 0, 0));
    EXPECT_EQ(run({"image", "crop", opaque, "0,0,16,16", "-o", path("cut.jpg")}), "");
    EXPECT_NEAR(value_at(read_picture(path("cut.jpg")), 8, 8, "R"), 1, 0.02);
}

TEST_F(CliImageEdit, CropRefuses) {
    const std::string in = exr("in.exr", part()),
                      clear = png("clear.png", picture(4, 4, {"R", "G", "B", "A"}));
    const auto error = [&](const std::string& from, const char* crop, const std::string& to,
                           int exit_code) {
        return error_of({"image", "crop", from, crop, "-o", to}, exit_code);
    };
    for (const char* outside : {"4,10,5,5", "5,9,5,5", "5,10,21,15", "5,10,20,16", "30,2,3,3"})
        EXPECT_NE(error(in, outside, path("o.exr"), 2)
                      .find("in.exr: holds only 5,10,20,15 (x,y,width,height) of its 40x30 frame"),
                  std::string::npos);
    EXPECT_NE(error(in, "0,0,41,1", path("o.exr"), 2).find("inside the 40x30 frame"),
              std::string::npos);
    for (const char* wrong : {"-1,0,3,3", "5,10,0,3", "5,10,3", "here"})
        EXPECT_NE(error(in, wrong, path("o.exr"), 2).find("x,y,width,height inside the frame"),
                  std::string::npos);
    EXPECT_NE(error(in, "5,10,2,2", in, 2).find("-o would overwrite the picture to cut"),
              std::string::npos);
    EXPECT_NE(error(in, "5,10,2,2", path("o.gif"), 2).find("o.gif"), std::string::npos);
    EXPECT_NE(error(clear, "0,0,2,2", path("o.exr"), 2).find("holds values for a display"),
              std::string::npos);
    EXPECT_NE(error(clear, "0,0,2,2", path("o.jpg"), 2).find("is transparent"), std::string::npos);
}

}  // namespace
}  // namespace petzval
