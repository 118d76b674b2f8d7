// SPDX-License-Identifier: Apache-2.0
#include "io/file/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "io/base/error.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using test::read_bytes;
using test::TemporaryFolder;

std::string text_of(const fs::path& path) {
    const auto bytes = read_bytes(path);
    return {bytes.begin(), bytes.end()};
}
mode_t mode_of(const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
}
/// What write_file_atomically says is wrong; empty for nothing.
std::string complaint(const fs::path& path, std::string_view text) {
    try {
        write_file_atomically(path, text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(AtomicFile, WritesANewFileWithTheUsersMask) {
    const TemporaryFolder folder;
    const mode_t mask = ::umask(027);
    write_file_atomically(folder / "a", "one");
    ::umask(mask);
    EXPECT_EQ(text_of(folder / "a"), "one");
    EXPECT_EQ(mode_of(folder / "a"), 0640u);
    EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, ReplacesAndKeepsPermissions) {
    const TemporaryFolder folder;
    write_file_atomically(folder / "a", "a longer first text");
    fs::permissions(folder / "a", fs::perms(0604));
    write_file_atomically(folder / "a", "two");
    EXPECT_EQ(text_of(folder / "a"), "two");
    EXPECT_EQ(mode_of(folder / "a"), 0604u);
}

TEST(AtomicFile, FollowsLinks) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "real");
    fs::create_symlink("real/a", folder / "link");
    fs::create_symlink("link", folder / "link2");
    for (const char* text : {"through a link to nothing", "and to a file"}) {
        write_file_atomically(folder / "link2", text);
        EXPECT_TRUE(fs::is_symlink(folder / "link2"));
        EXPECT_EQ(text_of(folder / "real" / "a"), text);
    }
    fs::create_symlink("loop", folder / "loop");
    EXPECT_NE(complaint(folder / "loop", "x"), "");
}

TEST(AtomicFile, AFailingWriteLeavesTheOldFileAndNothingElse) {
    const TemporaryFolder folder;
    write_file_atomically(folder / "a", "old");
    const std::string large(100000, 'x');
    {
        const test::FileSizeLimit limit(4096);
        const std::string message = complaint(folder / "a", large);
        EXPECT_EQ(message.find((folder / "a").string() + ": cannot be written: "), 0u) << message;
        EXPECT_NE(complaint(folder / "b", large), "");
    }
    EXPECT_EQ(text_of(folder / "a"), "old");
    EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, WritesInAnyOrderAndOnlyWhatIsCommitted) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder / "a");
        file.write(std::vector<uint8_t>{'c', 'd'}, 2);
        file.write(std::vector<uint8_t>{'a', 'x'}, 0);
        file.write(std::vector<uint8_t>{'b'}, 1);
        EXPECT_FALSE(fs::exists(folder / "a"));
        file.commit();
        EXPECT_EQ(text_of(folder / "a"), "abcd");
        AtomicFile forgotten(folder / "b");
        forgotten.write(std::vector<uint8_t>{'x'}, 0);
    }
    EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, KeepsTheFirstFailureForTheEnd) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a");
    {
        const test::FileSizeLimit limit(10);
        file.write(std::vector<uint8_t>(11), 0);
    }
    file.write(std::vector<uint8_t>(11), 0);  // would succeed now
    EXPECT_THROW(file.commit(), InputError);
    EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(AtomicFile, WritesMoreThanAPipeTakesAtOnce) {
    const TemporaryFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = text_of(pipe); });
    write_file_atomically(pipe, std::string(300000, 'y'));
    reader.join();
    EXPECT_EQ(received, std::string(300000, 'y'));
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, APipeThatNobodyReadsIsAnError) {
    const TemporaryFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(complaint(pipe, "x").find("nobody reads this pipe"), std::string::npos);
}

TEST(AtomicFile, WritesToDevices) {
    write_file_atomically("/dev/null", "gone");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_NE(complaint("/dev/full", "x").find("No space left on device"), std::string::npos);
}

TEST(AtomicFile, RefusesPlacesWhereNothingCanBe) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "b");
    test::write_bytes(folder / "file", {'x'});
    // No file system takes the last name, and the folder is there and may be written to.
    for (const fs::path& path : {folder / "none" / "a", folder / "b", folder / "file" / "a",
                                 fs::path(""), folder / std::string(300, 'x')}) {
        EXPECT_THROW(write_file_atomically(path, "x"), InputError) << path;
        EXPECT_THROW(check_writable(path), InputError) << path;
    }
    EXPECT_NE(complaint(folder / "none" / "a", "").find("there is no folder"), std::string::npos);
    EXPECT_EQ(folder.count(), 2u);
}

/// Somebody else than root while it lives, where the process is root.
class NotRoot {
  public:
    NotRoot() { left_ = ::geteuid() == 0 && ::seteuid(65534) == 0; }
    ~NotRoot() {
        if (left_ && ::seteuid(0) != 0) std::abort();
    }
    NotRoot(const NotRoot&) = delete;
    NotRoot& operator=(const NotRoot&) = delete;

  private:
    bool left_ = false;
};

TEST(AtomicFile, RefusesAFolderThatIsLocked) {
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms(0555));
    {
        const NotRoot somebody;
        if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere, and cannot be left";
        EXPECT_NE(complaint(folder / "a", "x").find("Permission denied"), std::string::npos);
        EXPECT_THROW(check_writable(folder / "a"), InputError);
    }
    fs::permissions(folder.path(), fs::perms::owner_all);
    EXPECT_EQ(folder.count(), 0u);
}

TEST(AtomicFile, AskingChangesNothing) {
    const TemporaryFolder folder;
    check_writable(folder / "a");
    EXPECT_EQ(folder.count(), 0u);
    write_file_atomically(folder / "a", "kept");
    check_writable(folder / "a");
    EXPECT_EQ(text_of(folder / "a"), "kept");
}

}  // namespace
}  // namespace petzval::io
