// SPDX-License-Identifier: Apache-2.0
#include "io/image/output.h"

#include <gtest/gtest.h>

#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::picture;
using test::TemporaryFolder;

TEST(Output, EndingChoosesFormatAndAlpha) {
    const TemporaryFolder folder;
    // Half covered, premultiplied, linear 0.1 each; one stop up.
    const Picture linear = picture(1, 1, {"R", "G", "B", "A"}, {0.1f, 0.1f, 0.1f, 0.5f});
    const DisplayOptions brighter{.exposure_ev = 1.f, .view = "raw"};
    for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
        check_output(folder / name, brighter);
        write_output(folder / name, linear, brighter);
    }
    EXPECT_EQ(read_picture(folder / "a.exr").pixels, linear.pixels) << "EXR stays linear";
    const Picture png = read_picture(folder / "a.png");
    ASSERT_EQ(png.channels.size(), 4u);
    EXPECT_NEAR(png.pixels[0], 0.4f, 0.5f / 255);
    EXPECT_NEAR(png.pixels[3], 0.5f, 0.51f / 255);
    const Picture jpeg = read_picture(folder / "a.jpg");
    ASSERT_EQ(jpeg.channels.size(), 3u);
    EXPECT_NEAR(jpeg.pixels[0], 0.2f, 2.f / 255);
}

TEST(Output, ChecksBeforeTheWork) {
    const TemporaryFolder folder;
    EXPECT_THROW(check_output(folder / "a.gif", {}), InputError);
    EXPECT_THROW(check_output(folder / "none" / "a.exr", {}), InputError);
    EXPECT_THROW(check_output(folder / "a.png", {.view = "filmic"}), InputError);
    EXPECT_THROW(check_output(folder / "a.jpg", {}, 65501, 1), OutputError);
    EXPECT_NO_THROW(check_output(folder / "a.jpg", {}, 65500, 1));
    EXPECT_NO_THROW(check_output(folder / "a.png", {}));
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Output, PartialPicturesStandBesideAndNeverReplace) {
    const TemporaryFolder folder;
    write_output(folder / "a.exr", test::noise(2, 2, {"R", "G", "B"}), {});
    const auto before = test::read_bytes(folder / "a.exr");
    const auto written = write_partial({folder / "a.exr", folder / "a.png", folder / "b.c.png"},
                                       test::noise(3, 2, {"R", "G", "B"}));
    ASSERT_EQ(written.size(), 2u);
    EXPECT_EQ(written[0].wanted, folder / "a.partial.exr");
    EXPECT_EQ(written[1].wanted, folder / "b.c.partial.exr");
    EXPECT_EQ(test::read_bytes(folder / "a.exr"), before);
    EXPECT_EQ(read_picture(folder / "b.c.partial.exr").width, 3);
}

}  // namespace
}  // namespace petzval::io
