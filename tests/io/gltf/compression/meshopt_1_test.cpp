// SPDX-License-Identifier: Apache-2.0
// What KHR_meshopt_compression has more than EXT_meshopt_compression: attributes of version 1, and
// colours. Streams of tests/data were written by the encoder of meshoptimizer 1.3 (npm).
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "io/gltf/compression/meshopt.h"
#include "io/gltf/compression/meshopt_filters.h"
#include "tests/support/meshes/meshopt_version_1.h"

namespace petzval::io {
namespace {

using Bytes = std::vector<uint8_t>;
using test::MeshoptVersion1;

MeshoptLayout attributes(uint64_t count, uint64_t stride,
                         MeshoptFilter filter = MeshoptFilter::None) {
    return {MeshoptMode::Attributes, filter, count, stride};
}

/// A file of the corpus without its head of four bytes.
Bytes stream_of(const char* name) {
    std::ifstream in(std::string(PETZVAL_TEST_DATA "/corpus/meshopt/") + name, std::ios::binary);
    Bytes all(std::istreambuf_iterator<char>(in), {});
    EXPECT_GT(all.size(), 4u) << name;
    return {all.begin() + 4, all.end()};
}

template <class T>
void append(Bytes& out, T value) {
    Bytes bytes(sizeof value);
    std::memcpy(bytes.data(), &value, sizeof value);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

/// The elements in tests/data/corpus/meshopt/version_1: shorts that grow, bytes, bits in the middle
/// of a word, and noise; each is best stored in a way of its own.
Bytes reference_elements() {
    Bytes out;
    uint32_t noise = 1;
    for (uint32_t i = 0; i < 500; ++i) {
        noise = noise * 1664525u + 1013904223u;
        append(out, uint16_t(i * i * 3 >> 2));
        append(out, uint16_t(60000 - i * 37));
        for (const uint32_t byte : {i * 3, 200 - i, i >> 3, 7u}) append(out, uint8_t(byte));
        append(out, 0x3f800000u ^ (i * i * 7 & 255) << 12);
        append(out, noise);
    }
    return out;
}

TEST(MeshoptVersion1, ReadsWhatTheLibraryWrites) {
    const Bytes stream = stream_of("version_1"), elements = reference_elements();
    EXPECT_EQ(Bytes(stream.end() - 4, stream.end()), (Bytes{1, 0, 0x42, 0}));  // the kinds
    EXPECT_EQ(meshopt_fault(attributes(500, 16), stream), "");
    EXPECT_EQ(decode_meshopt(attributes(500, 16), stream), elements);
}

/// Elements of which each byte is still, grows, jumps or is noise for a while.
Bytes some_elements(size_t count, size_t stride, std::mt19937& random) {
    Bytes out(count * stride);
    for (size_t k = 0; k < stride; ++k) {
        uint8_t value = uint8_t(random());
        uint32_t way = 0;
        for (size_t i = 0; i < count; ++i) {
            if (i % 40 == 0) way = random() % 4;
            if (way == 1) value = uint8_t(value + random() % 3 - 1);
            if (way == 2) value = uint8_t(value + random() % 20 - 10);
            if (way == 3) value = uint8_t(random());
            out[i * stride + k] = value;
        }
    }
    return out;
}

TEST(MeshoptVersion1, GivesTheBytesBack) {
    std::mt19937 random(3);
    for (const size_t stride : {4u, 8u, 20u, 36u, 64u, 256u})
        for (const size_t count : {1u, 15u, 16u, 17u, 200u, 255u, 256u, 257u, 700u}) {
            Bytes kinds(stride / 4);
            for (uint8_t& kind : kinds) {
                kind = uint8_t(random() % 3);
                if (kind == 2) kind = uint8_t(2 + 16 * (random() % 16));
            }
            const Bytes elements = some_elements(count, stride, random);
            const Bytes stream = MeshoptVersion1(uint32_t(random()), kinds).encode(elements);
            SCOPED_TRACE(std::to_string(count) + " of " + std::to_string(stride));
            EXPECT_EQ(meshopt_fault(attributes(count, stride), stream), "");
            EXPECT_EQ(decode_meshopt(attributes(count, stride), stream), elements);
        }
}

/// A stream of elements that are all the same, in the fewest bytes: headers of zeros, and the tail.
Bytes still(size_t count, size_t stride) {
    const size_t block = std::min<size_t>(8192 / stride / 16 * 16, 256);
    Bytes out = {0xa1};
    out.resize(1 + (count + block - 1) / block * stride / 4, 0xaa);
    if (stride * 5 / 4 < 24) out.resize(out.size() + 24 - stride * 5 / 4);
    out.resize(out.size() + stride, 9);
    out.resize(out.size() + stride / 4);
    return out;
}

TEST(MeshoptVersion1, KnowsTheFewestBytes) {
    for (const size_t stride : {4u, 12u, 20u, 36u, 256u})
        for (const size_t count : {1u, 17u, 256u, 257u, 4096u}) {
            SCOPED_TRACE(std::to_string(count) + " of " + std::to_string(stride));
            Bytes stream = still(count, stride);
            EXPECT_EQ(meshopt_fault(attributes(count, stride), stream), "");
            EXPECT_EQ(decode_meshopt(attributes(count, stride), stream), Bytes(count * stride, 9));
            EXPECT_LE(count * stride, 1024 * stream.size());
            stream.erase(stream.begin() + 1);
            EXPECT_NE(meshopt_fault(attributes(count, stride), stream), "");
        }
    EXPECT_NE(meshopt_fault(attributes(uint64_t(1) << 53, 256), still(1, 256)), "");
}

TEST(MeshoptVersion1, SeesThatAStreamIsBroken) {
    std::mt19937 random(8);
    const Bytes elements = some_elements(100, 8, random);
    const Bytes stream = MeshoptVersion1(4, {0, 1}).encode(elements);
    const auto decodes = [](const Bytes& bytes) {
        return meshopt_fault(attributes(100, 8), bytes).empty() &&
               decode_meshopt(attributes(100, 8), bytes).has_value();
    };
    EXPECT_TRUE(decodes(stream));
    for (size_t size = 0; size < stream.size(); ++size) {
        EXPECT_FALSE(decodes({stream.begin(), stream.begin() + ptrdiff_t(size)})) << size;
        EXPECT_FALSE(decodes({stream.begin() + ptrdiff_t(stream.size() - size), stream.end()}));
    }
    Bytes longer = stream;
    longer.insert(longer.end() - 24, 0);
    EXPECT_FALSE(decodes(longer));
    for (const int kind : {3, 15, 0x10, 0x21, 0xf3}) {
        Bytes unknown = stream;
        unknown.back() = uint8_t(kind);
        EXPECT_FALSE(decodes(unknown)) << kind;
    }
}

TEST(MeshoptVersion1, LeavesRubbishInBounds) {
    std::mt19937 random(9);
    for (int i = 0; i < 2000; ++i) {
        Bytes rubbish(40 + random() % 400);
        for (uint8_t& byte : rubbish) byte = uint8_t(random());
        rubbish[0] = 0xa1;
        rubbish.back() = uint8_t(random() % 3);
        const uint64_t count = 1 + random() % 300;
        if (meshopt_fault(attributes(count, 4), rubbish).empty())
            (void)decode_meshopt(attributes(count, 4), rubbish);
    }
}

/// The decoded component of a file of 100 colours: of the greatest value, `most`.
template <class T>
void expect_colours(const char* name, double most, double tolerance) {
    const auto layout = attributes(100, 4 * sizeof(T), MeshoptFilter::Color);
    const Bytes stream = stream_of(name);
    EXPECT_EQ(meshopt_fault(layout, stream), "");
    const Bytes bytes = decode_meshopt(layout, stream).value();
    for (int i = 0; i < 100; ++i) {
        const double expected[] = {i / 99., i * 7 % 100 / 99., 1 - i / 99., i % 3 / 2.};
        for (int k = 0; k < 4; ++k) {
            T value;
            std::memcpy(&value, &bytes[(4 * size_t(i) + size_t(k)) * sizeof value], sizeof value);
            EXPECT_NEAR(value / most, expected[k], tolerance) << i << " " << k;
        }
    }
}

// The encoder rounds luma and both chromas, so red, green and blue are off by 1.5 steps at most,
// and alpha, of one bit less, by one.
TEST(MeshoptColor, ReadsWhatTheLibraryWrites) {
    expect_colours<uint8_t>("color_8", 255, 1.51 / 255);
    expect_colours<uint16_t>("color_16", 65535, 1.51 / 4095);
}

/// Colours of `bits` bits that the YCoCg of integers holds exactly, there and back.
template <class T>
void expect_exact(int bits, void (*filter)(std::span<uint8_t>)) {
    std::mt19937 random(uint32_t(bits) + 1);
    const int greatest = (1 << bits) - 1;
    const double scale = double(std::numeric_limits<T>::max()) / greatest;
    for (int i = 0; i < 300; ++i) {
        int rgb[3];
        for (int& c : rgb) c = i < 2 ? i * greatest : int(random() % uint32_t(greatest + 1));
        if ((rgb[0] - rgb[2]) % 2 != 0) rgb[0] ^= 1;
        const int co = (rgb[0] - rgb[2]) / 2;
        if ((rgb[1] - rgb[2] - co) % 2 != 0) rgb[1] ^= 1;
        const int cg = (rgb[1] - rgb[2] - co) / 2, alpha = int(random()) & (greatest >> 1);
        const int y = rgb[1] - cg;
        const T in[4] = {T(y), T(co), T(cg), T(alpha | 1 << (bits - 1))};
        Bytes bytes(sizeof in);
        std::memcpy(bytes.data(), in, sizeof in);
        filter(bytes);
        T out[4];
        std::memcpy(out, bytes.data(), sizeof out);
        const int expected[4] = {rgb[0], rgb[1], rgb[2], 2 * alpha + alpha % 2};
        for (int k = 0; k < 4; ++k)
            EXPECT_NEAR(out[k], expected[k] * scale, 1) << bits << " bits, " << k;
    }
}

TEST(MeshoptColor, GivesColoursOfAnyPrecisionBack) {
    for (int bits = 2; bits <= 8; ++bits) expect_exact<uint8_t>(bits, filter_color_8);
    for (int bits = 2; bits <= 16; ++bits) expect_exact<uint16_t>(bits, filter_color_16);
}

TEST(MeshoptColor, LeavesRubbishInBounds) {
    std::mt19937 random(9);
    Bytes rubbish(8 * 1000);
    for (size_t i = 0; i < 64; ++i) rubbish[i] = i % 8 == 3 || i % 8 > 5 ? 0 : 9;  // no alpha
    for (size_t i = 64; i < rubbish.size(); ++i) rubbish[i] = uint8_t(random());
    const Bytes before = rubbish;
    filter_color_8(rubbish);
    filter_color_16(rubbish);
    EXPECT_EQ(rubbish.size(), before.size());
    EXPECT_TRUE(std::equal(before.begin(), before.begin() + 64, rubbish.begin()));
}

TEST(MeshoptColor, IsOfFourComponents) {
    for (const uint64_t stride : {4u, 8u})
        EXPECT_EQ(meshopt_fault(attributes(1, stride, MeshoptFilter::Color), still(1, stride)), "");
    EXPECT_NE(meshopt_fault(attributes(1, 12, MeshoptFilter::Color), still(1, 12)), "");
}

}  // namespace
}  // namespace petzval::io
