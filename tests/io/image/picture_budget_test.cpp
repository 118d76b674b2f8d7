// SPDX-License-Identifier: Apache-2.0
#include "io/picture/picture_budget.h"

#include <gtest/gtest.h>

#include "io/image/environment.h"
#include "io/image/picture_files.h"
#include "tests/support/pictures.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using test::noise;
using test::radiance_file;
using test::TemporaryFolder;
using test::write_bytes;

/// A PNG that announces this size and holds next to nothing: what decodes it finds it broken.
std::vector<uint8_t> announced(uint32_t width, uint32_t height, uint8_t bits = 8) {
    return tiny_png(width, height, bits, PngColour::Rgba, {{0, 0, 0, 0}});
}

/// The message with which an image is refused; empty where it is not.
std::string refused(const std::vector<uint8_t>& bytes, PictureBudget& budget) {
    try {
        (void)decode_image(bytes, "a.gltf", "/images/3", budget);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(PictureBudget, IsSharedAndGivesNumbers) {
    PictureBudget budget(10 << 20);
    EXPECT_EQ(budget.take(4 << 20, 6 << 20), "");
    EXPECT_EQ(budget.left_bytes(), uint64_t{6 << 20});
    EXPECT_EQ(budget.take(4 << 20, 3 << 20),
              "needs 7 MiB once it is decoded; of the 10 MiB for pictures other pictures take 4 "
              "MiB; scale it down, or give more ⟨max-memory⟩");
    EXPECT_EQ(budget.left_bytes(), uint64_t{6 << 20}) << "what is refused takes nothing";
    EXPECT_EQ(budget.take(6 << 20, 0), "");
    EXPECT_NE(budget.take(1, 0), "");
    EXPECT_GT(PictureBudget().left_bytes(), uint64_t{1} << 27);
}

// The header decides: of these pictures there is nothing to decode.
TEST(PictureBudget, IsAskedBeforeAnImageIsDecoded) {
    PictureBudget budget(100 << 20);
    const std::string message = refused(announced(4096, 4096), budget);
    EXPECT_TRUE(has(message,
                    "a.gltf: /images/3: the image of 4096x4096 pixels with 4 channels "
                    "needs 128 MiB"))
        << message;
    EXPECT_TRUE(has(message, "100 MiB")) << message;
    EXPECT_TRUE(has(refused(announced(2048, 1024, 16), budget), "cannot be decoded"));
    EXPECT_EQ(budget.left_bytes(), (uint64_t{100} << 20) - 2048 * 1024 * 16) << "floats";
}

// OpenImageIO decodes WebP when it opens it.
TEST(PictureBudget, IsAskedBeforeAWebPIsOpened) {
    const auto webp = [](const char* chunk, std::initializer_list<uint8_t> header) {
        std::vector<uint8_t> bytes = {'R', 'I', 'F', 'F', 64, 0, 0, 0, 'W', 'E', 'B', 'P'};
        bytes.insert(bytes.end(), chunk, chunk + 4);
        bytes.insert(bytes.end(), {48, 0, 0, 0});
        bytes.insert(bytes.end(), header);
        bytes.resize(72);
        return bytes;
    };
    const std::vector<std::vector<uint8_t>> files = {
        webp("VP8 ", {0x30, 1, 0, 0x9d, 0x01, 0x2a, 0x40, 0x1f, 0xb8, 0x0b}),
        webp("VP8L", {0x2f, 0x3f, 0xdf, 0xed, 0x02}),
        webp("VP8X", {0, 0, 0, 0, 0x3f, 0x1f, 0, 0xb7, 0x0b, 0})};
    for (const auto& bytes : files) {
        PictureBudget budget(150'000'000);
        EXPECT_TRUE(has(refused(bytes, budget), "of 8000x3000 pixels with 4 channels needs"));
        EXPECT_EQ(budget.left_bytes(), 150'000'000u);
        const TemporaryFolder folder;
        write_bytes(folder / "a.webp", bytes);
        EXPECT_TRUE(has(refusal([&] { (void)read_picture(folder / "a.webp", budget); }),
                        "a.webp: the picture of 8000x3000 pixels needs"));
    }
}

TEST(PictureBudget, AddsUpOverImages) {
    PictureBudget budget(3 * 64 * 64 * 4);
    const std::vector<uint8_t> image = tiny_png(64, 64, std::vector<uint8_t>(64 * 64 * 4, 9));
    EXPECT_EQ(refused(image, budget), "");
    EXPECT_EQ(refused(image, budget), "");
    EXPECT_TRUE(has(refused(image, budget), "needs"));
}

TEST(PictureBudget, IsAskedBeforeAPictureIsRead) {
    const TemporaryFolder folder;
    // The texels are missing: reading them would fail.
    write_bytes(folder / "sky.hdr", radiance_file(8192, 4096, std::vector<uint8_t>(32768)));
    const auto read = [&](uint64_t bytes) {
        return refusal([&] {
            PictureBudget budget(bytes);
            (void)read_picture(folder / "sky.hdr", budget);
        });
    };
    EXPECT_TRUE(has(read(383 << 20),
                    "sky.hdr: the picture of 8192x4096 pixels with 3 channels "
                    "needs 384 MiB"))
        << read(383 << 20);
    const auto as_sky = [&](uint64_t bytes) {
        return refusal([&] {
            PictureBudget budget(bytes);
            (void)load_sky(
                folder / "sky.hdr", 0, 1, [](const std::string&) {}, budget);
        });
    };
    EXPECT_TRUE(has(as_sky(uint64_t{1} << 30), "sky.hdr: the picture of 8192x4096"));

    write_exr(folder / "a.exr", noise(32, 16, {"R", "G", "B"}));
    PictureBudget small(32 * 16 * 12 - 1), enough(32 * 16 * 12);
    EXPECT_TRUE(has(refusal([&] { (void)read_picture(folder / "a.exr", small); }), "a.exr: "));
    EXPECT_EQ(read_picture(folder / "a.exr", enough).width, 32);
    EXPECT_EQ(enough.left_bytes(), 0u);
}

}  // namespace
}  // namespace petzval::io
