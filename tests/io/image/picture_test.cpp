// SPDX-License-Identifier: Apache-2.0
#include "io/image/picture_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/base/error.h"
#include "io/picture/limits.h"
#include "tests/support/pictures.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using Bytes = std::vector<uint8_t>;
using test::noise;
using test::picture;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

Image decode_file(const Bytes& bytes, const std::string& file, const std::string& place) {
    PictureBudget budget;
    return decode_image(bytes, file, place, budget);
}
Bytes texels8(const Bytes& png) {
    return std::get<std::vector<uint8_t>>(decode_file(png, "a.gltf", "/images/0").texels);
}
std::vector<float> texels_float(const Bytes& png) {
    return std::get<std::vector<float>>(decode_file(png, "a.gltf", "/images/0").texels);
}
Bytes png_chunk(std::string_view type, const Bytes& data) {
    Bytes chunk;
    put_png_chunk(chunk, type, data);
    return chunk;
}
template <class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(DecodeImage, KeepsBytesAndColourUnderZeroAlpha) {
    const Bytes png = tiny_png(2, 1, 8, PngColour::Rgba, {{200, 100, 50, 128, 255, 9, 7, 0}});
    EXPECT_EQ(texels8(png), (Bytes{200, 100, 50, 128, 255, 9, 7, 0}));
}

TEST(DecodeImage, SpreadsFewerChannels) {
    EXPECT_EQ(texels8(tiny_png(2, 1, 8, PngColour::Grey, {{20, 90}})),
              (Bytes{20, 20, 20, 255, 90, 90, 90, 255}));
    EXPECT_EQ(texels8(tiny_png(2, 1, 8, PngColour::GreyAlpha, {{20, 90, 30, 0}})),
              (Bytes{20, 20, 20, 90, 30, 30, 30, 0}));
    EXPECT_EQ(texels8(tiny_png(1, 2, 8, PngColour::Rgb, {{1, 2, 3}, {4, 5, 6}})),
              (Bytes{1, 2, 3, 255, 4, 5, 6, 255}));
}

TEST(DecodeImage, ExpandsPalettesAndBits) {
    Bytes palette = png_chunk("PLTE", {1, 2, 3, 200, 100, 50});
    EXPECT_EQ(texels8(tiny_png(2, 1, 8, PngColour::Palette, {{1, 0}}, palette)),
              (Bytes{200, 100, 50, 255, 1, 2, 3, 255}));
    put_png_chunk(palette, "tRNS", Bytes{0, 77});
    EXPECT_EQ(texels8(tiny_png(2, 1, 1, PngColour::Palette, {{0x80}}, palette)),
              (Bytes{200, 100, 50, 77, 1, 2, 3, 0}));
    EXPECT_EQ(texels8(tiny_png(2, 1, 1, PngColour::Grey, {{0x40}})),
              (Bytes{0, 0, 0, 255, 255, 255, 255, 255}));
}

TEST(DecodeImage, IgnoresGamma) {
    Bytes gamma;
    put_big_endian(gamma, 100000);
    EXPECT_EQ(texels8(tiny_png(1, 1, 8, PngColour::Rgb, {{9, 99, 199}}, png_chunk("gAMA", gamma))),
              (Bytes{9, 99, 199, 255}));
}

TEST(DecodeImage, SixteenBitsBecomeFloats) {
    const auto texels =
        texels_float(tiny_png(1, 1, 16, PngColour::Rgba, {{255, 255, 128, 0, 0, 1, 64, 0}}));
    ASSERT_EQ(texels.size(), 4u);
    EXPECT_FLOAT_EQ(texels[0], 1.f);
    EXPECT_FLOAT_EQ(texels[1], 32768 / 65535.f);
    EXPECT_FLOAT_EQ(texels[2], 1 / 65535.f);
    EXPECT_FLOAT_EQ(texels[3], 16384 / 65535.f);
}

TEST(DecodeImage, RefusesWhatIsNoImageAndSaysWhere) {
    for (const Bytes& bytes : {Bytes{}, Bytes{0x89, 'P'}, Bytes{'G', 'I', 'F', '8', '9', 'a'}}) {
        const std::string message =
            message_of([&] { (void)decode_file(bytes, "a.gltf", "/images/3"); });
        EXPECT_EQ(message.find("a.gltf: /images/3: "), 0u) << message;
        EXPECT_NE(message.find("PNG, JPEG or WebP"), std::string::npos) << message;
    }
}

TEST(DecodeImage, RefusesASmallFileThatAsksForGigabytes) {
    for (const uint32_t side : {20000u, 32768u, 40000u, 1000000u})
        EXPECT_THROW(
            (void)decode_file(tiny_png(side, side, 8, PngColour::Rgba, {{0, 0, 0, 0}}), "a", "b"),
            InputError);
    const std::string message = message_of([] {
        (void)decode_file(tiny_png(20000, 20000, 8, PngColour::Rgba, {{0, 0, 0, 0}}), "a", "b");
    });
    EXPECT_NE(message.find("claims 20000x20000 pixels"), std::string::npos) << message;
    EXPECT_THROW((void)decode_file(tiny_png(0, 1, 8, PngColour::Rgba, {}), "a", "b"), InputError);
}

TEST(SizeComplaint, AllowsWhatDeflateCanPackAndNoMore) {
    const int side = 8192;
    const uint64_t values = uint64_t{4} * side * side;
    EXPECT_EQ(size_complaint(side, side, 1, 4, values / 4000), "") << "a palette of one colour";
    EXPECT_NE(size_complaint(side, side, 1, 4, values / 5000), "");
    EXPECT_EQ(size_complaint(4096, 4096, 1, 4, 30), "");
    EXPECT_EQ(size_complaint(32768, 1, 1, 3, 200), "");
    EXPECT_NE(size_complaint(32769, 1, 1, 3, 1u << 30), "");
    EXPECT_NE(size_complaint(4, 4, 2, 3, 1000), "");
}

TEST(DecodeImage, RefusesFilesCutShort) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.jpg"}) {
        write_8bit(folder / name, noise(64, 64, {"R", "G", "B"}));
        const Bytes whole = read_bytes(folder / name);
        EXPECT_EQ(decode_file(whole, name, "").width, 64);
        for (const double part : {0.01, 0.2, 0.5, 0.9}) {
            const Bytes cut(whole.begin(), whole.begin() + ptrdiff_t(part * double(whole.size())));
            EXPECT_THROW((void)decode_file(cut, name, ""), InputError) << name << " " << part;
        }
    }
}

TEST(ReadPicture, RadianceValues) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.hdr",
                test::radiance_file(
                    2, 2, {128, 64, 32, 129, 255, 0, 1, 128, 0, 0, 0, 0, 200, 200, 200, 140}));
    const Picture p = read_picture(folder / "a.hdr");
    EXPECT_EQ(p.channels, (std::vector<std::string>{"R", "G", "B"}));
    const std::vector<float> exact{1.f, 0.5f, 0.25f, 255 / 256.f, 0,    1 / 256.f,
                                   0,   0,    0,     3200,        3200, 3200};
    ASSERT_EQ(p.pixels.size(), exact.size());
    // Decoders may add half a step of the mantissa.
    for (size_t i = 0; i < exact.size(); ++i)
        EXPECT_NEAR(p.pixels[i], exact[i], i < 6 ? 0.5f / 128 : 8.f) << i;
}

TEST(ReadPicture, RefusesRadianceWithoutItsMagic) {
    const TemporaryFolder folder;
    Bytes file = test::radiance_file(2, 1, {1, 2, 3, 128, 1, 2, 3, 128});
    file[0] = 'X';
    write_bytes(folder / "a.hdr", file);
    EXPECT_THROW((void)read_picture(folder / "a.hdr"), InputError);
}

TEST(ReadPicture, GoesByTheBytesAndNotByTheEnding) {
    const TemporaryFolder folder;
    write_8bit(folder / "a.png", picture(3, 2, {"R", "G", "B"}));
    std::filesystem::rename(folder / "a.png", folder / "a.exr");
    EXPECT_EQ(read_picture(folder / "a.exr").width, 3);
}

// Decoders that nothing needs are not reached: OpenImageIO would read this by its ending.
TEST(ReadPicture, RefusesFormatsThatItDoesNotNeed) {
    const TemporaryFolder folder;
    const std::string ppm = "P6 1 1 255\nabc";
    for (const char* name : {"a.ppm", "a.png", "a.exr"}) {
        write_bytes(folder / name, {ppm.begin(), ppm.end()});
        EXPECT_THROW((void)read_picture(folder / name), InputError) << name;
    }
}

// OpenEXR would take the memory that the attribute asks for.
TEST(ReadPicture, RefusesExrHeadersThatAskForMoreThanTheFile) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", picture(3, 2, {"R", "G", "B"}));
    Bytes file = test::read_bytes(folder / "a.exr");
    const std::string note("note\0string\0\xff\xff\xff\x6c", 16);  // its length is the last four
    file.insert(file.begin() + 8, note.begin(), note.end());
    write_bytes(folder / "b.exr", file);
    EXPECT_TRUE(has(refusal([&] { (void)read_picture(folder / "b.exr"); }),
                    "the picture has an attribute of "));
    write_bytes(folder / "c.exr", {file.begin(), file.begin() + 20});
    EXPECT_TRUE(
        has(refusal([&] { (void)read_picture(folder / "c.exr"); }), "damaged or cut short"));
    EXPECT_EQ(read_picture(folder / "a.exr").width, 3);
}

TEST(ReadPicture, RefusesWhatIsNotThere) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)read_picture(folder / "none.exr"), InputError);
    EXPECT_THROW((void)read_picture(folder.path()), InputError);
    const auto of_bytes = [&](const Bytes& bytes) {
        write_bytes(folder / "a.exr", bytes);
        const std::string name = (folder / "a.exr").string() + ": ",
                          message = refusal([&] { (void)read_picture(folder / "a.exr"); });
        return message.substr(message.starts_with(name) ? name.size() : 0);
    };
    const std::string no_picture =
        "no OpenEXR, Radiance, PNG, JPEG or WebP file; convert it to one of these";
    EXPECT_EQ(of_bytes({}), "is empty");
    EXPECT_EQ(of_bytes({'h', 'i'}),
              "the picture cannot be read: it is a text file, and " + no_picture);
    EXPECT_EQ(of_bytes(Bytes(64, 1)), "the picture cannot be read: it is " + no_picture);
}

TEST(ReadPicture, RefusesTheBrokenEnvironments) {
    const std::filesystem::path bad = PETZVAL_SHARED "/scenes/open/bad/hdr";
    if (!std::filesystem::exists(bad)) GTEST_SKIP() << "needs the folder ../shared";
    for (const char* name : {"no-magic.hdr", "truncated.hdr"})
        EXPECT_THROW((void)read_picture(bad / name), InputError) << name;
}

Picture layered_crop() {
    Picture p = noise(5, 4, {"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "depth.Z"});
    p.x = 3;
    p.y = 2;
    p.full_width = 20;
    p.full_height = 10;
    p.pixels[0] = -2.5f;
    p.pixels[1] = 1e20f;
    p.pixels[2] = std::numeric_limits<float>::denorm_min();
    p.pixels[3] = std::numeric_limits<float>::infinity();
    p.metadata = {{"petzval:samples", 16}, {"petzval:fstop", 2.8f}, {"petzval:scene", "a.glb"}};
    return p;
}

TEST(Exr, RoundTripKeepsPixelsWindowsNamesAndMetadata) {
    const TemporaryFolder folder;
    const Picture p = layered_crop();
    write_exr(folder / "a.exr", p);
    const Picture q = read_picture(folder / "a.exr");
    EXPECT_EQ(q.width, 5);
    EXPECT_EQ(q.height, 4);
    EXPECT_EQ(q.x, 3);
    EXPECT_EQ(q.y, 2);
    EXPECT_EQ(q.full_width, 20);
    EXPECT_EQ(q.full_height, 10);
    EXPECT_EQ(q.channels, p.channels);
    EXPECT_EQ(q.pixels, p.pixels);
    for (const auto& item : p.metadata)
        EXPECT_NE(std::find(q.metadata.begin(), q.metadata.end(), item), q.metadata.end())
            << item.first;
}

TEST(Exr, EqualPicturesAreEqualFilesWithoutADate) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", layered_crop());
    write_exr(folder / "b.exr", layered_crop());
    EXPECT_EQ(read_bytes(folder / "a.exr"), read_bytes(folder / "b.exr"));
    for (const auto& [name, value] : read_picture(folder / "a.exr").metadata) {
        EXPECT_NE(name, "HostComputer");
        EXPECT_TRUE(name != "DateTime" || std::get<std::string>(value).empty());
    }
}

// The attribute as OpenEXR's file layout has it: name, type, size, then x and y of red, green, blue
// and white.
TEST(Exr, EveryPictureSaysWhichColoursItsNumbersAre) {
    const TemporaryFolder folder;
    const std::array<float, 8> rec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    std::string wanted("chromaticities\0chromaticities\0\x20\0\0\0", 34);
    wanted.append(reinterpret_cast<const char*>(rec709.data()), sizeof rec709);
    for (const Picture& p : {layered_crop(), noise(2, 2, {"R", "G", "B", "S0.385,0nm"}),
                             noise(2, 2, {"Y"}), noise(2, 2, {"depth.Z"})}) {
        write_exr(folder / "a.exr", p);
        const Bytes bytes = read_bytes(folder / "a.exr");
        EXPECT_NE(std::string(bytes.begin(), bytes.end()).find(wanted), std::string::npos)
            << p.channels.front();
    }
}

TEST(EightBit, PngRoundsAndKeepsUnassociatedAlpha) {
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    write_8bit(folder / "a.png", picture(2, 2, {"R", "G", "B", "A"},
                                         {1.f, 0.5f, 0.f, 0.25f, 2.f, -1.f, nan, 1.f, 100.4f / 255,
                                          100.6f / 255, 1.f / 255, 0.f, 0, 0, 0, 0}));
    EXPECT_EQ(texels8(read_bytes(folder / "a.png")),
              (Bytes{255, 128, 0, 64, 255, 0, 0, 255, 100, 101, 1, 0, 0, 0, 0, 0}));
}

TEST(EightBit, PngHoldsJustTheCrop) {
    const TemporaryFolder folder;
    Picture p = noise(3, 2, {"B", "G", "R", "depth.Z"});
    p.x = 5;
    p.y = 6;
    p.full_width = p.full_height = 50;
    write_8bit(folder / "a.png", p);
    const Image image = decode_file(read_bytes(folder / "a.png"), "a.png", "");
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    const auto& texels = std::get<std::vector<uint8_t>>(image.texels);
    EXPECT_EQ(texels[0], uint8_t(p.pixels[2] * 255 + 0.5f)) << "channels go by name";
    EXPECT_EQ(texels[2], uint8_t(p.pixels[0] * 255 + 0.5f));
}

TEST(EightBit, JpegIsClose) {
    const TemporaryFolder folder;
    Picture p = picture(32, 16, {"R", "G", "B"});
    for (size_t i = 0; i < p.pixels.size(); ++i) p.pixels[i] = float(i % 96) / 96.f;
    write_8bit(folder / "a.jpg", p);
    const Picture q = read_picture(folder / "a.jpg");
    ASSERT_EQ(q.pixels.size(), p.pixels.size());
    double sum = 0;
    for (size_t i = 0; i < p.pixels.size(); ++i) sum += std::fabs(p.pixels[i] - q.pixels[i]);
    EXPECT_LT(sum / double(p.pixels.size()), 0.01);
}

TEST(PictureFormat, GoesByTheEnding) {
    EXPECT_EQ(picture_format("a.b/c.EXR"), PictureFormat::Exr);
    EXPECT_EQ(picture_format("c.png"), PictureFormat::Png);
    EXPECT_EQ(picture_format("c.Jpeg"), PictureFormat::Jpeg);
    for (const char* name : {"c", "c.tif", ".png", "exr"})
        EXPECT_THROW((void)picture_format(name), InputError) << name;
}

TEST(WritePicture, MissingFolderIsAnErrorThatNamesIt) {
    const TemporaryFolder folder;
    const auto path = folder / "none" / "a.exr";
    const std::string message = message_of([&] { write_exr(path, noise(2, 2, {"R"})); });
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
}

// Files with bytes changed or missing are refused or read, and nothing else happens.
TEST(Fuzz, BrokenFilesDoNoHarm) {
    const TemporaryFolder folder;
    write_8bit(folder / "a.png", noise(9, 7, {"R", "G", "B", "A"}));
    write_8bit(folder / "a.jpg", noise(17, 9, {"R", "G", "B"}));
    write_exr(folder / "a.exr", noise(9, 20, {"R", "G", "B", "depth.Z"}));
    write_bytes(folder / "a.hdr", test::radiance_file(9, 7, Bytes(9 * 7 * 4, 129)));
    std::minstd_rand random(11);
    int refused = 0;
    for (const std::string name : {"a.png", "a.jpg", "a.exr", "a.hdr"}) {
        const Bytes whole = read_bytes(folder / name);
        const auto broken = folder / ("broken-" + name);
        for (int i = 0; i < 250; ++i) {
            Bytes bytes = whole;
            if (i % 5 == 0) bytes.resize(random() % whole.size());
            const size_t changes = i % 5 == 0 ? 0 : 1 + random() % 4;
            for (size_t k = 0; k < changes; ++k) bytes[random() % whole.size()] = uint8_t(random());
            std::filesystem::remove(broken);  // some file systems sync what is overwritten
            write_bytes(broken, bytes);
            const bool texture = name == "a.png" || name == "a.jpg";
            refused += !message_of([&] {
                            if (texture)
                                (void)decode_file(bytes, "a.gltf", "/images/0");
                            else
                                (void)read_picture(broken);
                        }).empty();
        }
    }
    EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace petzval::io
