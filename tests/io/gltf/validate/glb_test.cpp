// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/glb.h"

#include <gtest/gtest.h>

#include "tests/support/refusal.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

constexpr uint32_t magic = 0x46546C67, json_type = 0x4E4F534A, bin_type = 0x004E4942;

struct Chunk {
    uint32_t type;
    std::string data;
};

/// A container whose header is right, whatever its chunks are.
std::vector<uint8_t> container(const std::vector<Chunk>& chunks) {
    std::vector<uint8_t> body;
    for (const Chunk& chunk : chunks) {
        TinyGltf::put_words(body, {uint32_t(chunk.data.size()), chunk.type});
        body.insert(body.end(), chunk.data.begin(), chunk.data.end());
    }
    std::vector<uint8_t> file;
    TinyGltf::put_words(file, {magic, 2, uint32_t(12 + body.size())});
    file.insert(file.end(), body.begin(), body.end());
    return file;
}

const std::vector<Chunk> good = {{json_type, "{}  "}, {bin_type, "abcd"}};

std::string refused(const std::vector<uint8_t>& file) {
    WarningLog warnings;
    return refusal([&] { (void)split_glb(file, "a.glb", warnings); });
}

TEST(Glb, FindsItsChunks) {
    const auto file = container(good);
    WarningLog none;
    const GlbChunks chunks = split_glb(file, "a.glb", none);
    EXPECT_EQ(chunks.json, "{}  ");
    ASSERT_TRUE(chunks.bin);
    EXPECT_EQ(chunks.bin->size(), 4u);
    EXPECT_EQ((*chunks.bin)[0], 'a');
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(is_glb(file));
    EXPECT_FALSE(is_glb(std::vector<uint8_t>{'g', 'l', 'T'}));
}

TEST(Glb, NeedsNoBinaryChunkAndSkipsUnknownOnes) {
    WarningLog log;
    auto file = container({{json_type, "{}  "}, {0x12345678, "    "}});
    file.push_back(0);
    EXPECT_FALSE(split_glb(file, "a.glb", log).bin);
    const auto found = log.lines();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(has(found[0], "1 bytes after the end"));
    EXPECT_TRUE(has(found[1], "byte 24: a chunk of unknown type 0x12345678"));
}

TEST(Glb, RefusesEveryTruncation) {
    const auto whole = container(good);
    for (size_t size = 0; size < whole.size(); ++size) {
        const std::vector<uint8_t> cut(whole.begin(), whole.begin() + ptrdiff_t(size));
        EXPECT_TRUE(has(refused(cut), "a.glb: byte ")) << size;
    }
}

TEST(Glb, RefusesChunksInDisorder) {
    EXPECT_TRUE(has(refused(container({{bin_type, "abcd"}})), "first chunk must be the JSON"));
    EXPECT_TRUE(has(refused(container({{7, "abcd"}, good[0]})), "first chunk must be the JSON"));
    EXPECT_TRUE(has(refused(container({good[0], good[0]})), "second JSON chunk"));
    EXPECT_TRUE(has(refused(container({{json_type, ""}})), "JSON chunk is empty"));
}

TEST(Glb, TakesChunksThatAreOddButPlain) {
    const auto read = [](const std::vector<uint8_t>& file, const std::string& warning) {
        WarningLog log;
        const GlbChunks chunks = split_glb(file, "a.glb", log);
        EXPECT_EQ(log.lines().size(), warning.empty() ? 0u : 1u);
        if (!warning.empty() && !log.empty()) {
            EXPECT_TRUE(has(log.lines()[0], warning));
        }
        return std::string(chunks.json) + "|" +
               (chunks.bin ? std::string(chunks.bin->begin(), chunks.bin->end()) : "none");
    };
    const Chunk second{bin_type, "efgh"}, zeros{json_type, std::string("{}\0\0", 4)};
    EXPECT_EQ(read(container({good[0], good[1], second}), "a second BIN chunk is skipped"),
              "{}  |abcd");
    EXPECT_EQ(read(container({zeros, good[1]}), ""), "{}|abcd");
    // A JSON chunk whose length nobody rounded up, the next one written at once or padded to.
    const Chunk odd{json_type, "{} "};
    EXPECT_EQ(read(container({odd, good[1]}), "a chunk's length is 3"), "{} |abcd");
    auto padded = container({odd, good[1]});
    padded.insert(padded.begin() + 12 + 8 + 3, ' ');
    ++padded[8];
    EXPECT_EQ(read(padded, "a chunk's length is 3"), "{} |abcd");
    EXPECT_EQ(read(container({odd}), "a chunk's length is 3"), "{} |none");
}

TEST(Glb, RefusesBrokenHeaders) {
    auto file = container(good);
    file[4] = 1;
    EXPECT_TRUE(has(refused(file), "byte 4: is a container of version 1"));
    file = container(good);
    file[12] = 0xFC;  // the JSON chunk's length
    EXPECT_TRUE(has(refused(file), "byte 12: a chunk promises 252 bytes, 16 are left"));
    file = container(good);
    file[24] = 8;  // the BIN chunk's length, of which 4 bytes are there
    EXPECT_TRUE(has(refused(file), "byte 24: a chunk promises 8 bytes, 4 are left"));
    file = container(good);
    file[11] = 0xFF;  // the container's length
    EXPECT_TRUE(has(refused(file), "byte 8: the header promises"));
}

}  // namespace
}  // namespace petzval::io
