// SPDX-License-Identifier: Apache-2.0
#include "io/file/overwrite.h"

#include <gtest/gtest.h>

#include "io/base/error.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

TEST(SameFile, ThroughSpellingsAndLinks) {
    const TemporaryFolder folder;
    test::write_text(folder / "a", "a");
    test::write_text(folder / "b", "a");
    fs::create_directory(folder / "sub");
    fs::create_symlink("../a", folder / "sub" / "soft");
    fs::create_symlink("soft", folder / "sub" / "softer");
    fs::create_hard_link(folder / "a", folder / "hard");
    for (const char* name : {"a", "./a", "sub/../a", "sub/soft", "sub/softer", "hard"})
        EXPECT_TRUE(same_file(folder / "a", folder / name)) << name;
    EXPECT_FALSE(same_file(folder / "a", folder / "b"));
    EXPECT_FALSE(same_file(folder / "a", folder / "none"));
}

TEST(SameFile, ThatIsNotThereYet) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    fs::create_directory_symlink(folder / "sub", folder / "link");
    fs::create_symlink("sub/a", folder / "soft");
    for (const char* name : {"sub/a", "sub/./a", "sub/../sub/a", "link/a", "soft"})
        EXPECT_TRUE(same_file(folder / "sub" / "a", folder / name)) << name;
    EXPECT_FALSE(same_file(folder / "sub" / "a", folder / "a"));
    EXPECT_FALSE(same_file(folder / "none" / "a", folder / "a"));
    fs::create_symlink("round", folder / "round");
    EXPECT_FALSE(same_file(folder / "round", folder / "a")) << "ends";
}

TEST(SameFile, DevicesLoseNothing) {
    EXPECT_FALSE(same_file("/dev/null", "/dev/null"));
}

TEST(SameFile, RefusalNamesBoth) {
    const TemporaryFolder folder;
    const std::string a = folder / "a", b = folder / "b";
    test::write_text(a, "a");
    const auto complaint = [](const std::vector<NamedFile>& out, const std::vector<NamedFile>& in) {
        try {
            refuse_overwriting(out, in);
        } catch (const ArgumentError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(complaint({{"-o", b}}, {{"the scene", a}}), "");
    EXPECT_EQ(complaint({{"-o", b}, {"-o", a}}, {{"the scene", a}}),
              a + ": -o would overwrite the scene (" + a + "); give another name");
    EXPECT_EQ(complaint({{"-o", b}, {"--stats", folder / "." / "b"}}, {}),
              (folder / "." / "b").string() + ": --stats would overwrite what -o writes (" + b +
                  "); give each a name of its own");
}

}  // namespace
}  // namespace petzval::io
