// SPDX-License-Identifier: Apache-2.0
#include "io/image/difference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "io/image/symmetric_mse.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::noise;
using test::picture;

TEST(ImageDiff, EqualPictures) {
    const Picture p = noise(4, 3, {"R", "G", "B", "A"});
    const auto layers = compare(p, p);
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers[0].layer, "RGB");
    EXPECT_EQ(layers[1].layer, "A");
    EXPECT_EQ(layers[0].value_count, 36u);
    EXPECT_EQ(layers[0].symmetric_mse, 0.);
    EXPECT_EQ(layers[0].rmse, 0.);
    EXPECT_EQ(layers[0].relative_mse, 0.);
    EXPECT_EQ(layers[0].max_channel, "");
    EXPECT_EQ(layers[0].psnr_db, std::numeric_limits<double>::infinity());
}

// Else a per cent would be compared with nits.
TEST(ImageDiff, TheErrorOfALayerIsALayerOfItsOwn) {
    const Picture p =
        noise(4, 3, {"R", "G", "B", "denoised.R", "denoised.G", "denoised.B", "denoised.error"});
    const auto layers = compare(p, p);
    ASSERT_EQ(layers.size(), 3u);
    EXPECT_EQ(layers[1].layer, "denoised");
    EXPECT_EQ(layers[1].symmetric_mse, 0.);
    EXPECT_EQ(layers[2].layer, "denoised.error");
    EXPECT_FALSE(layers[2].symmetric_mse);
}

TEST(ImageDiff, MatchesTheFormulas) {
    Picture a = picture(2, 1, {"R", "G", "B"}, {1.f, 2.f, 3.f, 0.f, 0.f, 0.f});
    Picture b = picture(2, 1, {"R", "G", "B"}, {1.f, 2.5f, 3.f, 0.f, 0.f, -2.f});
    a.x = b.x = 7;
    a.y = b.y = 5;
    const LayerDifference d = compare(a, b).at(0);
    EXPECT_DOUBLE_EQ(d.rmse, std::sqrt((0.25 + 4.) / 6));
    EXPECT_DOUBLE_EQ(d.relative_mse, (0.25 / (6.25 + 0.01) + 4. / (4. + 0.01)) / 6);
    EXPECT_DOUBLE_EQ(d.peak, 3.);
    EXPECT_DOUBLE_EQ(d.psnr_db, 20 * std::log10(3. / d.rmse));
    EXPECT_DOUBLE_EQ(d.max_abs, 2.);
    EXPECT_EQ(d.max_channel, "B");
    EXPECT_EQ(d.max_x, 8);
    EXPECT_EQ(d.max_y, 5);
}

TEST(ImageDiff, SymmetricMseHasTheReferencesFloor) {
    // The reference is an even grey of 0.8: so is its mid-grey, of which the floor is a quarter.
    const Picture a = picture(2, 1, {"R", "G", "B"}, {0.8f, 0.8f, 0.8f, 0.f, 1.6f, 0.8f});
    const Picture b = picture(2, 1, {"R", "G", "B"}, {0.8f, 0.8f, 0.8f, 0.8f, 0.8f, 0.8f});
    EXPECT_NEAR(floor_against(b).value(), 0.2, 1e-7);
    const double lost = 0.64 / (0.32 + 0.04), added = 0.64 / (0.5 * (2.56 + 0.64) + 0.04);
    EXPECT_NEAR(compare(a, b).at(0).symmetric_mse.value(), (lost + added) / 6, 1e-6);
    // Nothing of a is in the floor.
    Picture bright = a;
    bright.pixels[0] = 1e6f;
    EXPECT_NEAR(compare(bright, b).at(0).symmetric_mse.value(), (lost + added + 2) / 6, 1e-5);
}

TEST(ImageDiff, SymmetricMseDoesNotDependOnTheUnitOfLight) {
    const Picture a = noise(16, 16, {"R", "G", "B"});
    Picture b = a;
    std::reverse(b.pixels.begin(), b.pixels.end());
    const double mse = compare(a, b).at(0).symmetric_mse.value();
    EXPECT_GT(mse, 0.1);
    Picture a1000 = a, b1000 = b;
    for (float& v : a1000.pixels) v *= 1000;
    for (float& v : b1000.pixels) v *= 1000;
    EXPECT_NEAR(compare(a1000, b1000).at(0).symmetric_mse.value(), mse, 1e-5 * mse);
}

TEST(ImageDiff, SymmetricMseIsTheSameEitherWayAndBounded) {
    // b is a upside down, so that both have one tone; channels one by one, to keep luminances.
    const Picture a = noise(16, 16, {"R", "G", "B"});
    Picture b = a;
    for (size_t pixel = 0; pixel < 256; ++pixel)
        for (size_t c = 0; c < 3; ++c) b.pixels[3 * pixel + c] = a.pixels[3 * (255 - pixel) + c];
    const double there = compare(a, b).at(0).symmetric_mse.value();
    EXPECT_GT(there, 0.1);
    EXPECT_NEAR(compare(b, a).at(0).symmetric_mse.value(), there, 1e-9);
    const Picture black = picture(16, 16, {"R", "G", "B"});
    Picture bright = a;
    for (float& v : bright.pixels) v = 1e30f;
    EXPECT_LE(compare(black, a).at(0).symmetric_mse.value(), kMostSymmetricMse);
    EXPECT_GT(compare(black, a).at(0).symmetric_mse.value(), 0.5 * kMostSymmetricMse);
    EXPECT_NEAR(compare(bright, a).at(0).symmetric_mse.value(), kMostSymmetricMse, 1e-9);
    EXPECT_EQ(compare(black, black).at(0).symmetric_mse, 0.) << "no light, no floor";
    EXPECT_NEAR(compare(a, black).at(0).symmetric_mse.value(), kMostSymmetricMse, 0.01);
}

TEST(ImageDiff, SymmetricMseIsOfLightOnly) {
    const auto layers = [](const Picture& p) { return compare(p, p); };
    const auto rgb = layers(noise(4, 3, {"R", "G", "B", "A", "albedo.R", "S0.450,0nm"}));
    ASSERT_EQ(rgb.size(), 4u);
    EXPECT_TRUE(rgb[0].symmetric_mse);
    for (size_t i = 1; i < 4; ++i) EXPECT_FALSE(rgb[i].symmetric_mse) << rgb[i].layer;
    EXPECT_TRUE(layers(noise(4, 3, {"Y"})).at(0).symmetric_mse);
    EXPECT_FALSE(layers(noise(4, 3, {"R"})).at(0).symmetric_mse) << "no luminances";
    Picture shown = noise(4, 3, {"R", "G", "B"});
    shown.for_display = true;
    EXPECT_FALSE(layers(shown).at(0).symmetric_mse);
}

TEST(ImageDiff, LayersAreApartAndChannelsGoByName) {
    const Picture a = picture(1, 1, {"depth.Z", "R", "G", "B"}, {10.f, 1.f, 2.f, 3.f});
    const Picture b = picture(1, 1, {"B", "G", "R", "depth.Z"}, {3.f, 2.f, 1.f, 12.f});
    const auto layers = compare(a, b);
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers[0].rmse, 0.);
    EXPECT_EQ(layers[1].layer, "depth");
    EXPECT_DOUBLE_EQ(layers[1].rmse, 2.);
}

TEST(ImageDiff, CountsWhatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = INFINITY;
    const Picture a = picture(4, 1, {"R"}, {nan, 1.f, inf, 5.f});
    const Picture b = picture(4, 1, {"R"}, {nan, inf, 1.f, 4.f});
    const LayerDifference d = compare(a, b).at(0);
    EXPECT_EQ(d.not_finite, 3u);
    EXPECT_EQ(d.value_count, 1u);
    EXPECT_DOUBLE_EQ(d.rmse, 1.);
}

TEST(ImageDiff, FloorIsOfThePixelsThatAreFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Picture b =
        picture(4, 1, {"R", "G", "B"},
                {0.8f, 0.8f, 0.8f, nan, 9.f, 9.f, INFINITY, 0.f, 0.f, 0.8f, 0.8f, 0.8f});
    EXPECT_NEAR(floor_against(b).value(), 0.2, 1e-7);
    Picture a = b;
    a.pixels[0] = 0.f;
    const LayerDifference d = compare(a, b).at(0);
    EXPECT_EQ(d.not_finite, 2u);
    EXPECT_NEAR(d.symmetric_mse.value(), 0.64 / (0.32 + 0.04) / 10, 1e-6);
}

TEST(ImageDiff, RefusesPicturesOfAnotherKind) {
    const Picture p = noise(4, 3, {"R", "G", "B"});
    EXPECT_EQ(why_not_comparable(p, p), "");
    EXPECT_NE(why_not_comparable(p, noise(3, 4, {"R", "G", "B"})), "");
    EXPECT_NE(why_not_comparable(p, noise(4, 3, {"A"})), "");
    Picture crop = p;
    crop.x = 1;
    EXPECT_NE(why_not_comparable(p, crop), "");
    const test::TemporaryFolder folder;
    write_exr(folder / "a.exr", p);
    write_exr(folder / "b.exr", noise(3, 4, {"R", "G", "B"}));
    EXPECT_THROW((void)compare_files(folder / "a.exr", folder / "b.exr"), InputError);
    EXPECT_EQ(compare_files(folder / "a.exr", folder / "a.exr").layers.at(0).rmse, 0.);
}

// A picture that states its errors, and one that does not.
TEST(ImageDiff, ChannelsOfBothAreCompared) {
    const Picture plain = picture(2, 1, {"R", "G", "B"}, {1, 2, 3, 4, 5, 6});
    const Picture stated = picture(2, 1, {"R", "stderr.R", "G", "B"}, {1, 9, 2, 3, 4, 9, 5, 8});
    for (const bool exchanged : {false, true}) {
        const Picture &a = exchanged ? plain : stated, &b = exchanged ? stated : plain;
        EXPECT_EQ(why_not_comparable(a, b), "");
        const std::vector<LayerDifference> layers = compare(a, b);
        ASSERT_EQ(layers.size(), 1u);
        EXPECT_EQ(layers[0].value_count, 6u);
        EXPECT_EQ(layers[0].max_abs, 2.);
        EXPECT_EQ(layers[0].max_channel, "B");
        EXPECT_NE(channels_of_one(a, b).find("stderr.R"), std::string::npos);
    }
    EXPECT_EQ(channels_of_one(plain, plain), "");
    EXPECT_EQ(channels_of_one(plain, stated), "channels only in the latter: stderr.R");
    // A part of a layer does not pass for the whole.
    const std::vector<LayerDifference> red = compare(picture(2, 1, {"R"}, {1, 2}), plain);
    ASSERT_EQ(red.size(), 1u);
    EXPECT_EQ(red[0].layer, "R");
    EXPECT_EQ(red[0].symmetric_mse, std::nullopt);
}

TEST(ImageDiff, DisplayValuesAreNotComparedWithLight) {
    const Picture p = noise(4, 3, {"R", "G", "B"});
    const test::TemporaryFolder folder;
    write_exr(folder / "light.exr", p);
    write_8bit(folder / "shown.png", p);
    write_8bit(folder / "shown.jpg", p);
    const auto complaint = [&](const char* a, const char* b) -> std::string {
        try {
            static_cast<void>(compare_files(folder / a, folder / b));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    for (const char* shown : {"shown.png", "shown.jpg"}) {
        EXPECT_NE(complaint(shown, "light.exr")
                      .find("the former holds values for a display, the latter light; make a "
                            "picture for a display of the latter too, by petzval image view"),
                  std::string::npos)
            << complaint(shown, "light.exr");
        EXPECT_NE(complaint("light.exr", shown).find("the latter holds values for a display"),
                  std::string::npos);
    }
    EXPECT_EQ(complaint("shown.png", "shown.jpg"), "");
}

}  // namespace
}  // namespace petzval::io
