// SPDX-License-Identifier: Apache-2.0
#include "io/file/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/open_watch.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::TemporaryFolder;

std::string error_of(const std::string& content) {
    const TemporaryFolder folder;
    test::write_text(folder / "a", content);
    EXPECT_EQ(InputFile(folder / "a").error(), read_file(folder / "a").error);
    return read_file(folder / "a").error;
}

TEST(ReadFile, RefusesWhatStandsInPlaceOfAFile) {
    EXPECT_EQ(error_of(""), "is empty");
    EXPECT_EQ(error_of("version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 12\n"),
              "is only a pointer of Git LFS; git lfs pull fetches the file itself");
    for (const char* page : {"<!DOCTYPE html><title>", "\n\n\t<!doctype HTML>"})
        EXPECT_EQ(error_of(page), "is a web page; download the file itself") << page;
}

TEST(ReadFile, TakesWhatOnlySpeaksOfIt) {
    for (const char* text :
         {"x", "\n", " ", "<!DOCTYPE svg><html>", "<htm", "a <html>", "version https://git-lfs",
          "see version https://git-lfs.github.com/spec/"})
        EXPECT_EQ(error_of(text), "") << text;
    const TemporaryFolder folder;
    test::write_text(folder / "a", "123\n");
    EXPECT_EQ(read_file(folder / "a").bytes, (std::vector<uint8_t>{'1', '2', '3', '\n'}));
}

TEST(ReadFile, OpensNoPipeAndLeavesNoFileOpen) {
    const TemporaryFolder folder;
    const std::filesystem::path pipe = folder / "pipe";
    mkfifo(pipe.c_str(), 0600);
    const test::OpenWatch opened(pipe);
    EXPECT_EQ(read_file(pipe).error, "is not a regular file");
    EXPECT_FALSE(opened.has_happened());
    EXPECT_EQ(read_file(folder / "none").error, "no such file");
    EXPECT_EQ(read_file(pipe / "none").error, "no such file");
    EXPECT_EQ(read_file(folder.path()).error, "is a folder");
    test::write_text(folder / "a", "1");
    const auto open_files = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
    };
    const auto before = open_files();
    EXPECT_EQ(read_file(folder / "a").error, "");
    EXPECT_EQ(open_files(), before);
}

// Files of holes, which take no room on the disk.
TEST(ReadFile, OnlyWhatFitsIntoMemoryIsRead) {
    const TemporaryFolder folder;
    test::write_text(folder / "a", "1");
    std::filesystem::resize_file(folder / "a", (64 << 20) + 1);
    const FileBytes file = read_file(folder / "a");
    EXPECT_EQ(file.error, "");
    ASSERT_EQ(file.bytes.size(), size_t((64 << 20) + 1));
    EXPECT_EQ(file.bytes[0], '1');
    std::filesystem::resize_file(folder / "a", uint64_t(1) << 42);
    EXPECT_EQ(read_file(folder / "a").error,
              "has 4194304 MiB, more than the memory that can be had");
}

TEST(ReadFile, TellsTextsByWhatTheyDoNotHold) {
    for (const char* text : {"", "a\tb\r\nc", "größer", "~"}) EXPECT_TRUE(is_text(text)) << text;
    for (const std::string& bytes :
         {std::string(1, '\0'), std::string("a\x1b"), std::string("\x7f")})
        EXPECT_FALSE(is_text(bytes));
}

}  // namespace
}  // namespace petzval::io
