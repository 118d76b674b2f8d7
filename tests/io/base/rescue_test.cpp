// SPDX-License-Identifier: Apache-2.0
#include "io/file/rescue.h"

#include <gtest/gtest.h>

#include "io/base/error.h"
#include "io/file/atomic_file.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// The current folder of this process, for a while.
class CurrentFolder {
  public:
    explicit CurrentFolder(const fs::path& path) : before_(fs::current_path()) {
        fs::current_path(path);
    }
    CurrentFolder(const CurrentFolder&) = delete;
    CurrentFolder& operator=(const CurrentFolder&) = delete;
    ~CurrentFolder() { fs::current_path(before_); }

  private:
    fs::path before_;
};

std::string text_in(const fs::path& path) {
    const auto bytes = test::read_bytes(path);
    return {bytes.begin(), bytes.end()};
}

WriteOutcome write(const fs::path& path) {
    return write_or_rescue(
        path, [](const fs::path& to) { write_file_atomically(to, std::string_view("work")); });
}

TEST(Rescue, AFileThatCanBeWrittenIsWritten) {
    const TemporaryFolder folder;
    const WriteOutcome out = write(folder / "a.txt");
    EXPECT_TRUE(out.written());
    EXPECT_EQ(out.rescue, "");
    EXPECT_EQ(text_in(folder / "a.txt"), "work");
    EXPECT_EQ(folder.count(), 1u);
}

TEST(Rescue, ACopyLiesBesideANameThatIsTaken) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "a.txt");
    test::write_text(folder / "a.rescue.txt", "of before");
    fs::create_symlink(folder / "nothing", folder / "a.rescue-2.txt");
    const WriteOutcome out = write(folder / "a.txt");
    EXPECT_NE(out.error.find("it is a folder"), std::string::npos) << out.error;
    EXPECT_EQ(out.rescue, folder / "a.rescue-3.txt");
    EXPECT_EQ(text_in(out.rescue), "work");
    EXPECT_EQ(text_in(folder / "a.rescue.txt"), "of before");
    EXPECT_FALSE(fs::exists(folder / "nothing"));
    EXPECT_EQ(out.message(), out.error + "; a copy is in " + out.rescue.string());
}

TEST(Rescue, WithoutItsFolderACopyLiesInTheCurrentOne) {
    const TemporaryFolder folder;
    const CurrentFolder here(folder.path());
    const WriteOutcome out = write(folder / "gone" / "a.txt");
    EXPECT_EQ(out.rescue, folder / "a.rescue.txt");
    EXPECT_EQ(text_in(out.rescue), "work");
    // A device has no place for a copy either.
    EXPECT_EQ(write("/dev/full").rescue, folder / "full.rescue");
}

TEST(Rescue, WithoutThatInTheTemporaryOne) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "here");
    const CurrentFolder here(folder / "here");
    fs::remove(folder / "here");
    const WriteOutcome out = write(folder / "gone" / "a.txt");
    ASSERT_FALSE(out.rescue.empty());
    EXPECT_EQ(out.rescue.filename(), "a.rescue.txt");
    EXPECT_EQ(out.rescue.parent_path().parent_path(), fs::temp_directory_path());
    EXPECT_EQ(fs::status(out.rescue.parent_path()).permissions(), fs::perms::owner_all);
    EXPECT_EQ(text_in(out.rescue), "work");
    fs::remove_all(out.rescue.parent_path());
    fs::current_path(folder.path());
}

TEST(Rescue, WhereNothingCanBeWrittenItSaysSo) {
    const TemporaryFolder folder;
    const CurrentFolder here(folder.path());
    const test::FileSizeLimit limit(2);
    const WriteOutcome out = write(folder / "a.txt");
    EXPECT_EQ(out.rescue, "");
    EXPECT_EQ(out.message(), (folder / "a.txt").string() +
                                 ": cannot be written: File too large; no copy could be kept "
                                 "elsewhere either");
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Rescue, EveryActionIsTried) {
    int done = 0;
    const auto good = [&] { ++done; };
    const auto bad = [](const char* name) {
        return [name] { throw ArgumentError(name, "", "no"); };
    };
    EXPECT_NO_THROW(attempt_all({good, good}));
    EXPECT_THROW(attempt_all({bad("a"), good}), ArgumentError) << "a single error stays what it is";
    try {
        attempt_all({bad("a"), good, bad("b"), good});
        ADD_FAILURE();
    } catch (const OutputError& error) {
        EXPECT_STREQ(error.what(), "a: no; b: no");
    }
    EXPECT_EQ(done, 5);
}

}  // namespace
}  // namespace petzval::io
