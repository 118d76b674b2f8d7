// SPDX-License-Identifier: Apache-2.0
#include "io/image/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

namespace petzval {
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
    EXPECT_EQ(layers[0].rmse, 0.);
    EXPECT_EQ(layers[0].relative_mse, 0.);
    EXPECT_EQ(layers[0].max_channel, "");
    EXPECT_EQ(layers[0].psnr_db, std::numeric_limits<double>::infinity());
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

TEST(ImageDiff, RefusesPicturesOfAnotherKind) {
    const Picture p = noise(4, 3, {"R", "G", "B"});
    EXPECT_EQ(why_not_comparable(p, p), "");
    EXPECT_NE(why_not_comparable(p, noise(3, 4, {"R", "G", "B"})), "");
    EXPECT_NE(why_not_comparable(p, noise(4, 3, {"R", "G", "B", "A"})), "");
    Picture crop = p;
    crop.x = 1;
    EXPECT_NE(why_not_comparable(p, crop), "");
    const test::TemporaryFolder folder;
    write_exr(folder / "a.exr", p);
    write_exr(folder / "b.exr", noise(3, 4, {"R", "G", "B"}));
    EXPECT_THROW((void)compare_files(folder / "a.exr", folder / "b.exr"), InputError);
    EXPECT_EQ(compare_files(folder / "a.exr", folder / "a.exr").at(0).rmse, 0.);
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
}  // namespace petzval
