// SPDX-License-Identifier: Apache-2.0
// Images as artists' files have them: every kind gives the texels that glTF means, and says what of
// its colours is not listened to.
#include <gtest/gtest.h>

#include "io/image/picture_files.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_jpeg.h"
#include "tests/support/tiny_profile.h"

namespace petzval::io {
namespace {

using Bytes = std::vector<uint8_t>;

struct Decoded {
    Image image;
    ColourRemarks remarks;

    [[nodiscard]] Bytes texel(int x, int y) const {
        const auto& texels = std::get<Bytes>(image.texels);
        const auto at = texels.begin() + 4 * (ptrdiff_t(y) * image.width + x);
        return {at, at + 4};
    }
};

Decoded decode(const Bytes& bytes) {
    PictureBudget budget;
    Decoded out;
    out.image = decode_image(bytes, "a.gltf", "/images/0", budget, out.remarks);
    return out;
}

Bytes chunk(std::string_view type, const Bytes& data) {
    Bytes out;
    put_png_chunk(out, type, data);
    return out;
}

void expect_near(const Bytes& found, const Bytes& expected, int tolerance = 1) {
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], tolerance) << "channel " << i;
}

TEST(ImageKinds, InterlacedPng) {
    // Adam7 on 2x2 texels: the first, then the one right of it, then the second row.
    const Decoded png =
        decode(tiny_png(2, 2, 8, PngColour::Rgba,
                        {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12, 13, 14, 15, 16}}, {}, 1));
    EXPECT_EQ(png.texel(0, 0), (Bytes{1, 2, 3, 4}));
    EXPECT_EQ(png.texel(1, 0), (Bytes{5, 6, 7, 8}));
    EXPECT_EQ(png.texel(0, 1), (Bytes{9, 10, 11, 12}));
    EXPECT_EQ(png.texel(1, 1), (Bytes{13, 14, 15, 16}));
}

TEST(ImageKinds, PngOfSixteenBitsWithGreyAndAlpha) {
    const Decoded png =
        decode(tiny_png(1, 1, 16, PngColour::GreyAlpha, {{0x12, 0x34, 0x80, 0x00}}));
    const auto& texels = std::get<std::vector<float>>(png.image.texels);
    ASSERT_EQ(texels.size(), 4u);
    for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(texels[i], 0x1234 / 65535.f);
    EXPECT_FLOAT_EQ(texels[3], 0x8000 / 65535.f);
}

TEST(ImageKinds, PngWhoseTransparentColourIsNamed) {
    const Decoded grey =
        decode(tiny_png(2, 1, 8, PngColour::Grey, {{20, 90}}, chunk("tRNS", {0, 90})));
    EXPECT_EQ(grey.texel(0, 0), (Bytes{20, 20, 20, 255}));
    EXPECT_EQ(grey.texel(1, 0), (Bytes{90, 90, 90, 0}));
}

TEST(ImageKinds, WiderThanEightThousandTexels) {
    Bytes row(9000, 7);
    row.back() = 200;
    const Decoded png = decode(tiny_png(9000, 1, 8, PngColour::Grey, {row}));
    EXPECT_EQ(png.image.width, 9000);
    EXPECT_EQ(png.texel(0, 0), (Bytes{7, 7, 7, 255}));
    EXPECT_EQ(png.texel(8999, 0), (Bytes{200, 200, 200, 255}));
    std::vector<int> blocks(1100, 50);
    blocks.back() = 60;
    const Decoded jpeg = decode(tiny_jpeg({.blocks_across = 1100, .components = {blocks}}));
    EXPECT_EQ(jpeg.image.width, 8800);
    EXPECT_EQ(jpeg.texel(8799, 7), (Bytes{60, 60, 60, 255}));
}

TEST(ImageKinds, GreyAndColouredJpeg) {
    const Decoded grey = decode(tiny_jpeg({.blocks_across = 2, .components = {{10, 240}}}));
    EXPECT_EQ(grey.texel(7, 0), (Bytes{10, 10, 10, 255}));
    EXPECT_EQ(grey.texel(8, 7), (Bytes{240, 240, 240, 255}));
    // Y, Cb, Cr of JFIF: R = Y + 1.402 (Cr - 128), B = Y + 1.772 (Cb - 128).
    const Decoded colour = decode(tiny_jpeg({.components = {{100}, {128}, {178}}}));
    expect_near(colour.texel(3, 3), {170, 64, 100, 255});
    const Decoded rgb =
        decode(tiny_jpeg({.components = {{200}, {100}, {50}}, .adobe_transform = 0}));
    EXPECT_EQ(rgb.texel(0, 0), (Bytes{200, 100, 50, 255}));
    EXPECT_FALSE(rgb.remarks.inks);
    EXPECT_EQ(rgb.remarks.other_space, "");
}

TEST(ImageKinds, ProgressiveJpegIsTheSame) {
    TinyJpeg jpeg{.blocks_across = 3, .blocks_down = 2, .components = {{}, {}, {}}};
    for (int b = 0; b < 6; ++b)
        for (int c = 0; c < 3; ++c) jpeg.components[size_t(c)].push_back(100 + 20 * c + 9 * b);
    const Decoded baseline = decode(tiny_jpeg(jpeg));
    jpeg.progressive = true;
    const Decoded progressive = decode(tiny_jpeg(jpeg));
    EXPECT_EQ(progressive.image.texels, baseline.image.texels);
    EXPECT_NE(baseline.texel(0, 0), baseline.texel(8, 8));
}

// Adobe's files hold inks inverted: 255 is bare paper. Paper takes away what is not reflected by
// each ink, and by black.
TEST(ImageKinds, InksOfCmykJpegBecomeColours) {
    const Decoded cmyk =
        decode(tiny_jpeg({.components = {{200}, {100}, {50}, {128}}, .adobe_transform = 0}));
    expect_near(cmyk.texel(0, 0), {200 * 128 / 255, 100 * 128 / 255, 50 * 128 / 255, 255});
    EXPECT_TRUE(cmyk.remarks.inks);
    // YCCK: the first three are those of CMY's complement in YCbCr; here grey.
    const Decoded ycck =
        decode(tiny_jpeg({.components = {{90}, {128}, {128}, {255}}, .adobe_transform = 2}));
    expect_near(ycck.texel(0, 0), {165, 165, 165, 255});
    EXPECT_TRUE(ycck.remarks.inks);
}

TEST(ImageKinds, OrientationIsIgnored) {
    TinyJpeg jpeg{.blocks_across = 2, .components = {{10, 240}}};
    const Decoded plain = decode(tiny_jpeg(jpeg));
    for (const uint8_t orientation : {3, 6, 8}) {
        jpeg.segments = {jpeg_orientation(orientation)};
        const Decoded turned = decode(tiny_jpeg(jpeg));
        EXPECT_EQ(turned.image.width, 16);
        EXPECT_EQ(turned.image.texels, plain.image.texels) << int(orientation);
    }
}

TEST(ImageKinds, JpegOfTwelveBitsIsRefused) {
    PictureBudget budget;
    const std::string why = refusal([&] {
        (void)decode_image(tiny_jpeg({.components = {{2000}}, .bits = 12}), "a.gltf", "/images/0",
                           budget);
    });
    EXPECT_TRUE(has(why, "/images/0: the image cannot be decoded")) << why;
}

// What a file says of its colours changes no texel (glTF 2.0, section 3.8.3).
TEST(ImageKinds, OtherColourSpacesAreNamedAndIgnored) {
    const auto png = [](const Bytes& extra) {
        return decode(tiny_png(1, 1, 8, PngColour::Rgb, {{200, 100, 50}}, extra));
    };
    Bytes chrm;
    for (const uint32_t xy : {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000})
        put_big_endian(chrm, xy);
    const auto srgb = tiny_profile(kSrgbPrimaries, 2.2, "a name");
    const auto adobe = tiny_profile(kAdobePrimaries, 2.2, "Adobe RGB (1998)");
    const auto linear = tiny_profile(kSrgbPrimaries, 1, "straight");
    const std::pair<Bytes, const char*> cases[] = {
        {{}, ""},
        {chunk("sRGB", {0}), ""},
        {chunk("gAMA", {0, 0, 0xB1, 0x8F}), ""},                     // 0.45455
        {chunk("gAMA", {0, 1, 0x86, 0xA0}), "a gamma of 1 (gAMA)"},  // 1
        {chunk("cHRM", chrm), "primaries of its own (cHRM)"},
        {chunk("cICP", {1, 13, 0, 1}), ""},
        {chunk("cICP", {9, 16, 0, 1}), "primaries 9 and curve 16 of ITU-T H.273 (cICP)"},
        {png_profile_chunk(srgb), ""},
        {png_profile_chunk(adobe), "the profile Adobe RGB (1998)"},
        {png_profile_chunk(linear), "the profile straight"},
    };
    for (const auto& [extra, expected] : cases) {
        const Decoded found = png(extra);
        EXPECT_EQ(found.texel(0, 0), (Bytes{200, 100, 50, 255})) << expected;
        EXPECT_EQ(found.remarks.other_space, expected);
    }
    // JPEG: APP2, one part of one.
    for (const auto& [profile, expected] :
         {std::pair(srgb, ""), {adobe, "the profile Adobe RGB (1998)"}}) {
        Bytes content = {'I', 'C', 'C', '_', 'P', 'R', 'O', 'F', 'I', 'L', 'E', 0, 1, 1};
        content.insert(content.end(), profile.begin(), profile.end());
        const Decoded jpeg =
            decode(tiny_jpeg({.components = {{90}}, .segments = {jpeg_segment(0xE2, content)}}));
        EXPECT_EQ(jpeg.texel(0, 0), (Bytes{90, 90, 90, 255}));
        EXPECT_EQ(jpeg.remarks.other_space, expected);
    }
}

// A profile cut anywhere, or with any byte changed, does no harm.
TEST(ImageKinds, BrokenProfilesDoNoHarm) {
    const Bytes whole = tiny_profile(kAdobePrimaries, 2.2, "Adobe RGB (1998)");
    for (size_t i = 0; i < whole.size(); ++i) {
        Bytes cut(whole.begin(), whole.begin() + ptrdiff_t(i)), changed = whole;
        changed[i] ^= 0xFF;
        for (const Bytes& profile : {cut, changed}) {
            const Decoded found = decode(
                tiny_png(1, 1, 8, PngColour::Rgb, {{200, 100, 50}}, png_profile_chunk(profile)));
            EXPECT_EQ(found.texel(0, 0), (Bytes{200, 100, 50, 255})) << i;
        }
    }
}

}  // namespace
}  // namespace petzval::io
