// SPDX-License-Identifier: Apache-2.0
#include "io/aperture/aperture_file.h"

#include <cmath>
#include <numbers>

#include "camera/iris/iris.h"
#include "io/aperture/svg_path.h"
#include "io/image/picture_files.h"
#include "tests/support/clip.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using test::TemporaryFolder;

// A shape file of that text.
camera::Polygon read(const std::string& elements,
                     const std::string& attributes = "viewBox=\"0 0 20 20\"") {
    const TemporaryFolder folder;
    const std::string text = "<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" " +
                             attributes + ">\n" + elements + "\n</svg>\n";
    test::write_text(folder / "iris.svg", text);
    return read_svg_aperture(folder / "iris.svg");
}
camera::Polygon path(const std::string& d, const std::string& more = "") {
    return read("<path d=\"" + d + "\" " + more + "/>");
}
// Positive where the outer contour runs clockwise in the file, where y points down.
double area(const camera::Polygon& polygon) {
    double sum = 0;
    for (const auto& contour : polygon.contours) sum -= test::signed_area(contour);
    return sum;
}
void expect_contour(const camera::Polygon& polygon, const std::vector<V2d>& vertices) {
    ASSERT_EQ(polygon.contours.size(), 1u);
    ASSERT_EQ(polygon.contours[0].size(), vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i)
        EXPECT_LT((polygon.contours[0][i] - vertices[i]).length(), 1e-12) << i;
}

TEST(SvgAperture, LinesOfEveryKind) {
    // In the file from (4, 4), y down; here about the middle of the viewBox, y up.
    const std::vector<V2d> box = {{-6, 6}, {2, 6}, {2, -1}, {-6, -1}};
    expect_contour(path("M4,4 L12 4 L12 11 L4 11 Z"), box);
    expect_contour(path("m4 4 8 0 0 7-8 0z"), box);
    expect_contour(path("M4 4H12V11H4Z"), box);
    expect_contour(path("m4 4h8v7h-8"), box);
    expect_contour(path("M4 4 12 4 12 11 4 11 4 4Z"), box);
    expect_contour(read("<polygon points=\"4,4 12,4 12,11 4,11\"/>"), box);
    expect_contour(read("<rect x=\"4\" y=\"4px\" width=\"8\" height=\"7\"/>"), box);
    expect_contour(path("M+4e0 4.0L1.2e1,4,12 11 4 11"), box);
    expect_contour(read("<path d=\"M4 4H12V11H4Z\"/>", ""),
                   {{-4, 3.5}, {4, 3.5}, {4, -3.5}, {-4, -3.5}});
    expect_contour(read("<path d=\"M4 4H12V11H4Z\"/>", "viewBox=\"-2,0 24 20\""), box);
}

TEST(SvgAperture, Subpaths) {
    const camera::Polygon two = path("M0 0H8V8H0Z m2 2 v2 h2 v-2 z M10 0h4v4h-4z");
    ASSERT_EQ(two.contours.size(), 3u);
    EXPECT_NEAR(area(two), 64 - 4 + 16, 1e-12);
    EXPECT_FALSE(two.even_odd);
    // After Z a path goes on from where it began.
    const svg::Outline outline = read_svg_path("M5 6 h2 v2 z l-2 0 l0 -2 z", {"file", "d"});
    ASSERT_EQ(outline.size(), 2u);
    EXPECT_EQ(outline[1].start, V2d(5, 6));
    EXPECT_EQ(outline[1].curves[1].end, V2d(3, 4));
    EXPECT_TRUE(path("M0 0H8V8H0Z M2 2h2v2h-2z", "fill-rule=\"evenodd\"").even_odd);
    EXPECT_TRUE(path("M0 0H8V8H0Z", "style=\"stroke:red; fill-rule : evenodd\"").even_odd);
}

TEST(SvgAperture, Curves) {
    // Area under a parabola: 2/3 of base times height; a height is half of the control's.
    EXPECT_NEAR(area(path("M0 10 Q5 0 10 10Z")), 2.0 / 3 * 10 * 5, 5e-3);
    EXPECT_NEAR(area(path("m0 10 q5-10 10 0z")), 2.0 / 3 * 10 * 5, 5e-3);
    EXPECT_NEAR(area(path("M0 10 Q5 0 10 10 T20 10 V20 H0Z")), 200, 2e-3);
    EXPECT_NEAR(area(path("M0 10 Q5 0 10 10 t10 0 V20 H0Z")), 200, 2e-3);
    // A cubic from (0, 0) over (0, 1), (1, 1) to (1, 0) encloses 3/5.
    EXPECT_NEAR(area(path("M0 10 C0 0 10 0 10 10Z")), 60, 5e-3);
    EXPECT_NEAR(area(path("m0 10 c0-10 10-10 10 0z")), 60, 5e-3);
    EXPECT_NEAR(area(path("M0 10 C0 4 5 4 5 10 S10 16 10 10 V20H0Z")), 100, 5e-3);
    EXPECT_NEAR(area(path("M0 10 c0-6 5-6 5 0 s5 6 5 0 V20H0Z")), 100, 5e-3);
    // Without a curve before it, S and T begin straight on.
    EXPECT_NEAR(area(path("M0 10 T10 0 V10Z")), 50, 1e-9);
    EXPECT_NEAR(area(path("M0 10 S10 0 10 10Z")), 30, 5e-3);
}

TEST(SvgAperture, Arcs) {
    const double pi = std::numbers::pi;
    EXPECT_NEAR(area(path("M0 10 A10 10 0 0 1 20 10Z")), 50 * pi, 0.02);
    EXPECT_NEAR(area(path("M0 10 a10 10 0 0120 0z")), 50 * pi, 0.02) << "packed flags";
    EXPECT_NEAR(area(path("M0 10 A1 1 0 0 1 20 10Z")), 50 * pi, 0.02) << "radius too small";
    EXPECT_NEAR(area(path("M10 0 A10 10 0 0 1 20 10 L10 10Z")), 25 * pi, 0.02);
    EXPECT_NEAR(area(path("M10 0 A10 10 0 1 0 20 10 L10 10Z")), -75 * pi, 0.03);
    EXPECT_NEAR(area(path("M10 0 A10 10 0 0 0 20 10 L20 0Z")), -25 * pi, 0.02)
        << "bends the other way";
    EXPECT_NEAR(area(path("M10 0 A5 10 90 0 1 10 10Z")), 25 * pi, 0.02) << "turned ellipse";
    EXPECT_NEAR(area(path("M0 0 A0 5 0 0 1 20 0 V10Z")), 100, 1e-9) << "no radius: a line";
    EXPECT_NEAR(area(read("<circle cx=\"9\" cy=\"9\" r=\"7\"/>")), 49 * pi, 0.02);
    EXPECT_NEAR(area(read("<ellipse cx=\"9\" rx=\"7\" ry=\"2\"/>")), 14 * pi, 0.01);
    EXPECT_NEAR(area(read("<rect width=\"8\" height=\"6\" rx=\"2\"/>")), 48 - 4 * (4 - pi), 0.01);
    EXPECT_NEAR(area(read("<rect width=\"8\" height=\"6\" rx=\"9\" ry=\"3\"/>")), 12 * pi, 0.01);
    const camera::Polygon round = read("<circle cx=\"10\" cy=\"10\" r=\"7\"/>");
    for (const V2d& p : round.contours[0]) EXPECT_NEAR(p.length(), 7, 1e-4 * 7);
}

TEST(SvgAperture, LengthsInUnits) {
    const double pi = std::numbers::pi, mm_px = 96 / 25.4;
    EXPECT_NEAR(area(read("<circle r=\"2mm\"/>")), 4 * mm_px * mm_px * pi, 0.05);
    EXPECT_NEAR(area(read("<circle r=\"3pt\"/>")), 16 * pi, 0.05);
    EXPECT_NEAR(area(read("<circle r=\"0.25pc\"/>")), 16 * pi, 0.05);
    EXPECT_NEAR(area(read("<rect width=\"1in\" height=\"2.54cm\"/>")), 96 * 96, 1e-6);
}

TEST(SvgAperture, Transforms) {
    const std::vector<V2d> box = {{-6, 6}, {2, 6}, {2, -1}, {-6, -1}};
    const auto with = [](const std::string& transform) {
        return path("M0 0H8V7H0Z", "transform=\"" + transform + "\"");
    };
    expect_contour(with("translate(4,4)"), box);
    expect_contour(with("translate(4) translate(0 4)"), box);
    expect_contour(with("matrix(1 0 0 1 4 4)"), box);
    expect_contour(with("translate(4 4) scale(2) scale(.5,.5)"), box);
    expect_contour(with("rotate(90 10 10)"), {{10, 10}, {10, 2}, {3, 2}, {3, 10}});
    expect_contour(with("translate(20),rotate(90)"), {{10, 10}, {10, 2}, {3, 2}, {3, 10}});
    expect_contour(with("skewX(45)"), {{-10, 10}, {-2, 10}, {5, 3}, {-3, 3}});
    expect_contour(with("skewY(45)"), {{-10, 10}, {-2, 2}, {-2, -5}, {-10, 3}});
    expect_contour(read("<g transform=\"translate(4 0)\"><g transform=\"scale(2)\">"
                        "<path transform=\"translate(0 2)\" d=\"M0 0H4V3.5H0Z\"/></g></g>"),
                   box);
    // Curves go with them, arcs too.
    EXPECT_NEAR(area(read("<circle r=\"3\" transform=\"scale(2 1) rotate(30)\"/>")),
                18 * std::numbers::pi, 0.01);
}

TEST(SvgAperture, WhatIsNotDrawnIsNoShape) {
    EXPECT_NEAR(area(read("<!-- c --><title>x</title><defs><path d=\"M0 0H9V9Z\"/></defs>\n<g>"
                          "<circle r=\"1\"/></g><metadata><rect/></metadata>")),
                std::numbers::pi, 1e-3);
}

TEST(SvgAperture, Refuses) {
    const auto complaint = [](const std::string& elements) {
        return refusal([&] { (void)read(elements); });
    };
    EXPECT_TRUE(has(complaint("<g/>"), "has no path"));
    EXPECT_TRUE(has(complaint("<circle r=\"1\"/>\n<rect width=\"1\" height=\"1\"/>"),
                    "iris.svg: line 4, rect: is a second shape after the circle of line 3"));
    EXPECT_TRUE(has(complaint("<text>star</text>"), "cannot be an aperture"));
    EXPECT_TRUE(has(complaint("<path fill=\"none\" d=\"M0 0H9V9Z\"/>"), "has no fill"));
    EXPECT_TRUE(has(complaint("<g style=\"fill:none\"><circle r=\"1\"/></g>"), "has no fill"));
    EXPECT_TRUE(has(complaint("<circle r=\"0\"/>"), "r must be above 0"));
    EXPECT_TRUE(has(complaint("<circle r=\"5%\"/>"), "line 3, circle/r, character 2"));
    EXPECT_TRUE(has(complaint("<circle/>"), "a number is missing"));
    EXPECT_TRUE(has(complaint("<circle r=\"nan\"/>"), "a number is missing"));
    EXPECT_TRUE(has(complaint("<circle r=\"1e999\"/>"), "finite"));
    EXPECT_TRUE(has(complaint("<path d=\"M0 0 L5 5 X\"/>"),
                    "line 3, path/d, character 12: 'X' is no command"));
    EXPECT_TRUE(has(complaint("<path d=\"L5 5\"/>"), "must begin with M"));
    EXPECT_TRUE(has(complaint("<path d=\"5 5\"/>"), "a command is missing"));
    EXPECT_TRUE(has(complaint("<path d=\"M0 0 1 1 2 0Z3 3\"/>"), "a command is missing"));
    EXPECT_TRUE(has(complaint("<path d=\"M0 0 L5\"/>"), "a number is missing"));
    EXPECT_TRUE(has(complaint("<path d=\"M0 0 A5 5 0 2 0 9 9\"/>"), "a flag of an arc"));
    EXPECT_TRUE(has(complaint("<path/>"), "has no contour"));
    EXPECT_TRUE(has(complaint("<path d=\"M0 0L9 9\"/>"), "has 2 vertices"));
    EXPECT_TRUE(has(complaint("<polygon points=\"0,0 9,9 9,0 0,9\"/>"),
                    "line 3, polygon: contour 1, vertex 1 at (0, 0): the edge from here meets"));
    EXPECT_TRUE(has(complaint("<circle r=\"1\" transform=\"scale(0)\"/>"), "contour 1"));
    EXPECT_TRUE(has(complaint("<circle r=\"1\" transform=\"spin(3)\"/>"), "is no transform"));
    EXPECT_TRUE(has(complaint("<circle r=\"1\" transform=\"rotate(1 2)\"/>"), "rotate(1 or 3)"));
    EXPECT_TRUE(has(complaint("<circle r=\"1\" transform=\"scale(2\"/>"), "')' is missing"));
    EXPECT_TRUE(has(complaint("<path d=\"M0 0\">"), "is no XML"));
    const std::string many = "c0-10 10-10 10 0 c-3-5-6-5-9 0 ";
    std::string d = "M0 0";
    for (int i = 0; i < 4000; ++i) d += many;
    EXPECT_TRUE(has(complaint("<path d=\"" + d + "\"/>"), "over 10000 vertices"));
    std::string deep;
    for (int i = 0; i < 200000; ++i) deep += "<g>";
    EXPECT_TRUE(has(complaint(deep), "is no XML"));
    for (int i = 0; i < 200000; ++i) deep += "</g>";
    EXPECT_TRUE(has(complaint(deep), "has no path"));

    const TemporaryFolder folder;
    const std::string html = "<html/>";
    test::write_text(folder / "page.svg", html);
    test::write_bytes(folder / "empty.svg", {});
    EXPECT_TRUE(
        has(refusal([&] { (void)parse_aperture("page.svg", folder.path()); }), "is no SVG"));
    EXPECT_TRUE(
        has(refusal([&] { (void)parse_aperture("empty.svg", folder.path()); }), "is empty"));
    EXPECT_TRUE(has(refusal([&] { (void)read_svg_aperture(folder.path()); }), "is a folder"));
}

// Cut short anywhere, a path is read or refused.
TEST(SvgAperture, CutShort) {
    const std::string whole =
        "M1 2l3 4h5v6H7V8c1 2 3 4 5 6s1 2 3 4q1 2 3 4t5 6a1 2 30 0110 10Zm3 3z";
    for (size_t n = 0; n <= whole.size(); ++n) {
        try {
            (void)read_svg_path(whole.substr(0, n), {"cut", "d"});
        } catch (const InputError&) {
        }
    }
    EXPECT_EQ(read_svg_path(whole, {"cut", "d"}).size(), 1u);
    EXPECT_EQ(read_svg_path("M0 0 1 1 2 0ZZZ", {"cut", "d"}).size(), 1u);
}

TEST(MaskAperture, RoundingIsNoFault) {
    const TemporaryFolder folder;
    const auto read = [&](float open) {
        Picture p{{.width = 2,
                   .height = 1,
                   .full_width = 2,
                   .full_height = 1,
                   .channels = {"Y"},
                   .metadata = {}},
                  {open, 0.5f}};
        write_exr(folder / "mask.exr", p);
        return read_mask_aperture(folder / "mask.exr", PictureBudget()).texels[0];
    };
    EXPECT_EQ(read(1.00000012f), 1.f);
    EXPECT_EQ(read(-0.001f), 0.f);
    EXPECT_TRUE(has(refusal([&] { (void)read(1.1f); }), "0 is opaque and 1 is open"));
    EXPECT_TRUE(has(refusal([&] { (void)read(std::nanf("")); }), "0 is opaque and 1 is open"));
}

TEST(MaskAperture, LuminanceTimesAlpha) {
    const TemporaryFolder folder;
    const auto mask_of = [&](const std::vector<uint8_t>& png) {
        test::write_bytes(folder / "mask.png", png);
        return std::get<camera::Mask>(parse_aperture("mask.png", folder.path()));
    };
    const camera::Mask rgba =
        mask_of(tiny_png(3, 2, {255, 255, 255, 255, 255, 0,   0,   255, 0,   255, 0,   51,  //
                                0,   0,   255, 255, 128, 128, 128, 255, 255, 255, 255, 0}));
    ASSERT_EQ(rgba.width, 3);
    ASSERT_EQ(rgba.height, 2);
    const float expected[] = {1, 0.2126f, 0.7152f * 0.2f, 0.0722f, 128.f / 255, 0};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(rgba.texels[i], expected[i], 1e-6) << i;
    EXPECT_EQ(rgba.texels[0], 1.f);
    const camera::Mask grey = mask_of(tiny_png(2, 1, 8, PngColour::Grey, {{51, 255}}));
    EXPECT_NEAR(grey.texels[0], 0.2, 1e-6);
    const camera::Mask with_alpha = mask_of(tiny_png(1, 1, 8, PngColour::GreyAlpha, {{102, 51}}));
    EXPECT_NEAR(with_alpha.texels[0], 0.4 * 0.2, 1e-6);
    EXPECT_TRUE(has(refusal([&] {
                        (void)mask_of(tiny_png(1, 1, {0, 0, 0, 255}));
                    }),
                    "mask.png: the mask is black everywhere"));
}

TEST(ParseAperture, Names) {
    const auto count = [](const std::string& text) {
        return std::get<camera::Polygon>(parse_aperture(text)).contours[0].size();
    };
    EXPECT_TRUE(std::holds_alternative<camera::Disk>(parse_aperture("circle")));
    EXPECT_EQ(count("square"), 4u);
    EXPECT_EQ(count("rhomboid"), 4u);
    EXPECT_EQ(count("triangle"), 3u);
    EXPECT_EQ(std::get<camera::Polygon>(parse_aperture("frame")).contours.size(), 2u);
    EXPECT_EQ(count("star:7"), 14u);
    EXPECT_EQ(count("polygon:6"), 6u);
    EXPECT_GT(count("polygon:6,0,0.5"), 20u);
    const auto turned = std::get<camera::Polygon>(parse_aperture("polygon:6,-30")).contours[0][0];
    EXPECT_NEAR(turned.x, 0.5, 1e-12);
    EXPECT_NEAR(turned.y, std::sqrt(0.75), 1e-12);
}

TEST(ParseAperture, ListsWhatIsPossible) {
    const auto complaint = [](const std::string& text) {
        try {
            (void)parse_aperture(text);
        } catch (const ArgumentError& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    for (const char* text :
         {"", "heart", "star:", "star:x", "star:5,1", "polygon:6,0,0,0", "polygon:6,",
          "polygon:6,,1", "polygon: 6", "polygon:6;3", "nosuch.svg", "nosuch.png", "hexagon:6"})
        EXPECT_TRUE(has(complaint(text), "polygon:N[,ROTATION_DEG[,ROUNDNESS]]")) << text;
    EXPECT_EQ(complaint("Star"), "star: needs a number; did you mean star:5?");
    EXPECT_EQ(complaint("polygon"), "polygon: needs a number; did you mean polygon:5?");
    EXPECT_TRUE(has(complaint("heart"), "heart: is neither a file nor a shape; give circle"));
    for (const char* text : {"star:2", "star:101", "star:5.5", "star:-5", "star:nan", "star:1e99"})
        EXPECT_TRUE(has(complaint(text), "tips of a star must be from 3 to 100")) << text;
    EXPECT_TRUE(has(complaint("polygon:2"), "blades must be from 3 to 100"));
    EXPECT_TRUE(has(complaint("polygon:5,nan"), "rotation must be a finite"));
    EXPECT_TRUE(has(complaint("polygon:5,inf"), "rotation must be a finite"));
    EXPECT_TRUE(has(complaint("polygon:5,0,nan"), "roundness must be from 0"));
    EXPECT_TRUE(has(complaint("polygon:5,0,1.01"), "roundness must be from 0"));
}

}  // namespace
}  // namespace petzval::io
