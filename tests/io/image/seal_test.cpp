// SPDX-License-Identifier: Apache-2.0
#include "io/picture/seal.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/file/read_file.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

/// A file of some megabytes with the unfilled value at these places, sealed.
class Sealed {
  public:
    Sealed(size_t size, const std::vector<size_t>& places) : bytes(size) {
        uint32_t random = 1;
        for (uint8_t& byte : bytes) byte = uint8_t((random = random * 1664525 + 1013904223) >> 24);
        const std::string_view unsealed = kUnsealed;
        for (const size_t place : places)
            std::copy(unsealed.begin(), unsealed.end(), bytes.begin() + std::ptrdiff_t(place));
        AtomicFile file(path);
        file.write(bytes, 0);
        seal(file);
        file.commit();
        bytes = test::read_bytes(path);
    }
    [[nodiscard]] std::string at(size_t place) const {
        return {bytes.begin() + std::ptrdiff_t(place),
                bytes.begin() + std::ptrdiff_t(place + std::string_view(kUnsealed).size())};
    }

    test::TemporaryFolder folder;
    std::filesystem::path path = folder / "a.bin";
    std::vector<uint8_t> bytes;
};

constexpr size_t kMegabyte = 1 << 20;

TEST(Seal, HoldsForAllOfAFile) {
    for (const size_t size : {kMegabyte / 2, kMegabyte, 2 * kMegabyte, 5 * kMegabyte / 2}) {
        Sealed file(size, {100});
        const std::string seal = file.at(100);
        EXPECT_EQ(seal.size(), std::string_view(kUnsealed).size());
        EXPECT_NE(seal, kUnsealed);
        EXPECT_TRUE(is_as_written(file.path, seal)) << size;
        for (const size_t at : {size_t(0), size / 3, size / 2 + 7, size - 1}) {
            std::vector<uint8_t> bad = file.bytes;
            bad[at] ^= 1;
            test::write_bytes(file.path, bad);
            EXPECT_FALSE(is_as_written(file.path, seal)) << size << ' ' << at;
        }
        file.bytes.push_back(0);
        test::write_bytes(file.path, file.bytes);
        EXPECT_FALSE(is_as_written(file.path, seal)) << size;
        file.bytes.resize(size - 1);
        test::write_bytes(file.path, file.bytes);
        EXPECT_FALSE(is_as_written(file.path, seal)) << size;
    }
}

// JPEG has metadata twice.
TEST(Seal, IsFilledInWhereverItStands) {
    const size_t next = 100 + std::string_view(kUnsealed).size();
    const Sealed file(kMegabyte, {100, next, 5000});
    const std::string seal = file.at(100);
    EXPECT_EQ(file.at(next), seal);
    EXPECT_EQ(file.at(5000), seal);
    EXPECT_TRUE(is_as_written(file.path, seal));
}

// A picture of another program, or of an older version.
TEST(Seal, OfAFileWithoutOneNothingIsKnown) {
    const Sealed file(1000, {});
    for (const char* seal : {"", "fnv1a-", kUnsealed, "fnv1a-00000000000000000"})
        EXPECT_FALSE(is_as_written(file.path, seal)) << seal;
}

TEST(Seal, OfAPngNothingFollowsItsEnd) {
    // The signature, and IEND with its CRC (annex C.1 of the specification).
    const std::vector<uint8_t> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0,    0,
                                   0,    0,   'I', 'E', 'N',  'D',  0xAE, 0x42, 0x60, 0x82};
    EXPECT_TRUE(is_whole_png(png, true));
    std::vector<uint8_t> more = png;
    more.push_back(0);
    EXPECT_TRUE(is_whole_png(more, false));  // as decoders have it
    EXPECT_FALSE(is_whole_png(more, true));
    for (size_t size = 0; size < png.size(); ++size)
        EXPECT_FALSE(is_whole_png(std::span(png).first(size), false)) << size;
}

}  // namespace
}  // namespace petzval::io
