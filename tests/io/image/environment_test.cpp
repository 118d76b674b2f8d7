// SPDX-License-Identifier: Apache-2.0
#include "io/image/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::picture;
using test::TemporaryFolder;

struct Loaded {
    Sky sky;
    std::vector<std::string> notices;
};
Loaded load(const std::filesystem::path& path) {
    Loaded loaded;
    PictureBudget budget;
    loaded.sky = load_sky(
        path, 0.f, 2.f, [&](const std::string& line) { loaded.notices.push_back(line); }, budget);
    return loaded;
}

TEST(Environment, TakesColourByNameAndGrey) {
    const TemporaryFolder folder;
    Picture p = picture(8, 4, {"A", "B", "G", "R"});
    for (size_t i = 0; i < p.pixels.size(); i += 4) {
        p.pixels[i + 1] = 3.f;
        p.pixels[i + 3] = 1.f;
    }
    write_exr(folder / "a.exr", p);
    const Loaded colour = load(folder / "a.exr");
    EXPECT_TRUE(colour.notices.empty());
    const Rgb radiance = colour.sky.radiance(unit(V3f(1, 2, 3)));
    EXPECT_FLOAT_EQ(radiance[0], 2.f);
    EXPECT_FLOAT_EQ(radiance[1], 0.f);
    EXPECT_FLOAT_EQ(radiance[2], 6.f);
    write_exr(folder / "grey.exr", picture(4, 2, {"Y"}, std::vector<float>(8, 0.5f)));
    EXPECT_FLOAT_EQ(load(folder / "grey.exr").sky.radiance({0, 1, 0})[2], 1.f);
}

TEST(Environment, SaysWhatItMendsOrDoubts) {
    const TemporaryFolder folder;
    Picture p = picture(4, 4, {"R", "G", "B"}, std::vector<float>(48, 1.f));
    p.pixels[5] = -1.f;
    p.pixels[6] = -2.f;
    write_exr(folder / "a.exr", p);
    const auto notices = load(folder / "a.exr").notices;
    ASSERT_EQ(notices.size(), 2u);
    EXPECT_NE(notices[0].find("2 negative values"), std::string::npos) << notices[0];
    EXPECT_NE(notices[1].find("2:1"), std::string::npos) << notices[1];
    write_exr(folder / "dark.exr", picture(4, 2, {"Y"}, std::vector<float>(8, -1.f)));
    EXPECT_EQ(load(folder / "dark.exr").sky.radiance({0, 1, 0})[0], 0.f);
}

TEST(Environment, ReadsInfiniteSunsAsTheGreatestValue) {
    const TemporaryFolder folder;
    Picture p = picture(8, 4, {"Y"}, std::vector<float>(32, 1.f));
    p.pixels[0] = 500.f;
    p.pixels[1] = std::numeric_limits<float>::infinity();
    write_exr(folder / "a.exr", p);
    const Loaded sun = load(folder / "a.exr");
    ASSERT_EQ(sun.notices.size(), 1u);
    EXPECT_NE(sun.notices[0].find("3 infinite values read as the greatest"), std::string::npos)
        << sun.notices[0];
    p.pixels[1] = 500.f;
    write_exr(folder / "b.exr", p);
    EXPECT_EQ(sun.sky.average_luminance(), load(folder / "b.exr").sky.average_luminance());
}

TEST(Environment, ReadsWhatIsNoNumberAsBlack) {
    const TemporaryFolder folder;
    Picture p = picture(8, 4, {"Y"}, std::vector<float>(32, 1.f));
    p.pixels[3] = std::numeric_limits<float>::quiet_NaN();
    write_exr(folder / "a.exr", p);
    const Loaded hole = load(folder / "a.exr");
    ASSERT_EQ(hole.notices.size(), 1u);
    EXPECT_NE(hole.notices[0].find("3 values that are no number read as 0"), std::string::npos)
        << hole.notices[0];
    EXPECT_TRUE(std::isfinite(hole.sky.average_luminance()));
}

TEST(Environment, RefusesOtherPictures) {
    const TemporaryFolder folder;
    write_8bit(folder / "a.png", picture(4, 2, {"R", "G", "B"}));
    EXPECT_THROW((void)load(folder / "a.png"), InputError);
    EXPECT_THROW((void)load(folder / "none.hdr"), InputError);
    write_exr(folder / "depth.exr", picture(4, 2, {"depth.Z"}));
    EXPECT_THROW((void)load(folder / "depth.exr"), InputError);
    Picture crop = picture(4, 2, {"R", "G", "B"});
    crop.full_width = 8;
    crop.full_height = 4;
    write_exr(folder / "crop.exr", crop);
    EXPECT_THROW((void)load(folder / "crop.exr"), InputError);
}

TEST(Environment, RefusesTheBrokenOnesAndTakesTheOthers) {
    const std::filesystem::path open = PETZVAL_SHARED "/scenes/open";
    if (!std::filesystem::exists(open)) GTEST_SKIP() << "needs the folder ../shared";
    for (const char* name : {"no-magic.hdr", "truncated.hdr"})
        EXPECT_THROW((void)load(open / "bad" / "hdr" / name), InputError) << name;
    for (const auto& entry : std::filesystem::directory_iterator(open / "env")) {
        if (entry.path().extension() != ".hdr") continue;
        EXPECT_GT(load(entry.path()).sky.average_luminance(), 0.f) << entry.path();
    }
}

}  // namespace
}  // namespace petzval::io
