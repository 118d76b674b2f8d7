// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/meshopt.h"

#include <gtest/gtest.h>

#include <random>

#include "io/gltf/compression/meshopt_filters.h"
#include "tests/support/meshes/encoders.h"

namespace petzval::io {
namespace {

using test::Grid;
using Bytes = std::vector<uint8_t>;

MeshoptLayout attributes_layout(uint64_t count, uint64_t stride,
                                MeshoptFilter filter = MeshoptFilter::None) {
    return {MeshoptMode::Attributes, filter, count, stride};
}

Bytes decoded_stream(const MeshoptLayout& layout, const Bytes& stream) {
    EXPECT_EQ(meshopt_fault(layout, stream), "");
    return decode_meshopt(layout, stream).value();
}

Bytes copy(std::span<const uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
}

TEST(Meshopt, GivesTheBytesBack) {
    const Grid grid(21);
    EXPECT_EQ(decoded_stream(attributes_layout(grid.points(), 12),
                             test::encode_attributes(test::bytes_of(grid.positions), 12)),
              copy(test::bytes_of(grid.positions)));
    EXPECT_EQ(decoded_stream(attributes_layout(grid.points(), 4),
                             test::encode_attributes(test::bytes_of(grid.colours), 4)),
              grid.colours);
    EXPECT_EQ(decoded_stream({MeshoptMode::Indices, MeshoptFilter::None, grid.indices.size(), 4},
                             test::encode_indices(grid.indices, grid.points())),
              copy(test::bytes_of(grid.indices)));
    const std::vector<uint16_t> shorts(grid.indices.begin(), grid.indices.end());
    EXPECT_EQ(decoded_stream({MeshoptMode::Indices, MeshoptFilter::None, grid.indices.size(), 2},
                             test::encode_indices(grid.indices, grid.points())),
              copy(test::bytes_of(shorts)));
}

TEST(Meshopt, TrianglesMayTurnButStay) {
    const Grid grid(21);
    const Bytes bytes =
        decoded_stream({MeshoptMode::Triangles, MeshoptFilter::None, grid.indices.size(), 4},
                       test::encode_triangles(grid.indices, grid.points()));
    std::vector<uint32_t> indices(grid.indices.size());
    std::memcpy(indices.data(), bytes.data(), bytes.size());
    for (size_t i = 0; i < indices.size(); i += 3) {
        int turns = 0;
        for (size_t k = 0; k < 3; ++k)
            turns += indices[i] == grid.indices[i + k] &&
                     indices[i + 1] == grid.indices[i + (k + 1) % 3] &&
                     indices[i + 2] == grid.indices[i + (k + 2) % 3];
        EXPECT_EQ(turns, 1);
    }
}

// The fewest bytes are those that the encoder takes for elements that are all the same.
TEST(Meshopt, KnowsTheFewestBytes) {
    for (const uint64_t stride : {4u, 12u, 32u, 36u, 100u, 256u})
        for (const uint64_t count : {1u, 16u, 17u, 255u, 256u, 257u, 1000u, 4096u}) {
            const Bytes stream = test::encode_attributes(Bytes(count * stride, 7), stride);
            EXPECT_EQ(meshopt_fault(attributes_layout(count, stride), stream), "");
            const Bytes shorter(stream.begin(), stream.end() - 1);
            EXPECT_NE(meshopt_fault(attributes_layout(count, stride), shorter), "")
                << count << " of " << stride;
        }
    const std::vector<uint32_t> same(300, 0);
    for (const auto mode : {MeshoptMode::Triangles, MeshoptMode::Indices}) {
        const Bytes stream = mode == MeshoptMode::Triangles ? test::encode_triangles(same, 1)
                                                            : test::encode_indices(same, 1);
        EXPECT_EQ(meshopt_fault({mode, MeshoptFilter::None, 300, 4}, stream), "");
        EXPECT_NE(meshopt_fault({mode, MeshoptFilter::None, 3000, 4}, stream), "");
    }
}

TEST(Meshopt, RefusesWhatTheExtensionForbids) {
    const auto fault = [](MeshoptMode mode, MeshoptFilter filter, uint64_t count, uint64_t stride,
                          uint8_t header) {
        return meshopt_fault({mode, filter, count, stride}, Bytes(1000, header));
    };
    using enum MeshoptMode;
    using enum MeshoptFilter;
    EXPECT_EQ(fault(Attributes, None, 3, 12, 0xa0), "");
    for (const uint64_t stride : {0u, 2u, 6u, 260u})
        EXPECT_NE(fault(Attributes, None, 3, stride, 0xa0), "");
    EXPECT_EQ(fault(Attributes, None, 3, 12, 0xa1), "");
    EXPECT_NE(fault(Attributes, None, 3, 12, 0xa2), "");
    EXPECT_NE(fault(Indices, Color, 4, 4, 0xd1), "");
    EXPECT_NE(fault(Attributes, None, 3, 12, 0xe0), "");
    EXPECT_NE(fault(Attributes, Octahedral, 3, 12, 0xa0), "");
    EXPECT_NE(fault(Attributes, Quaternion, 3, 4, 0xa0), "");
    EXPECT_EQ(fault(Triangles, None, 3, 4, 0xe1), "");
    EXPECT_NE(fault(Triangles, None, 4, 4, 0xe1), "");
    EXPECT_NE(fault(Triangles, None, 3, 1, 0xe1), "");
    EXPECT_NE(fault(Triangles, None, 3, 4, 0xe2), "");
    EXPECT_NE(fault(Triangles, Exponential, 3, 4, 0xe1), "");
    EXPECT_EQ(fault(Indices, None, 4, 2, 0xd1), "");
    EXPECT_NE(fault(Indices, None, 4, 3, 0xd1), "");
    EXPECT_NE(meshopt_fault(attributes_layout(1, 4), {}), "");
    EXPECT_NE(fault(Attributes, None, uint64_t(1) << 53, 256, 0xa0), "");
}

TEST(Meshopt, SeesThatAStreamIsBroken) {
    const Grid grid(21);
    Bytes stream = test::encode_attributes(test::bytes_of(grid.positions), 12);
    stream.resize(stream.size() - 40);
    EXPECT_EQ(meshopt_fault(attributes_layout(grid.points(), 12), stream), "");
    EXPECT_FALSE(decode_meshopt(attributes_layout(grid.points(), 12), stream));
}

/// Random unit vectors, four numbers each.
std::vector<float> unit_vectors(size_t count) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<float> out;
    for (size_t i = 0; i < count; ++i) {
        std::array<float, 4> v;
        float length = 0;
        for (float& x : v) {
            x = normal(random);
            length += x * x;
        }
        for (const float x : v) out.push_back(x / std::sqrt(length));
    }
    return out;
}

/// The greatest difference of the numbers of type T.
template <class T>
int difference(const Bytes& a, const Bytes& b) {
    int greatest = 0;
    for (size_t i = 0; i < a.size(); i += sizeof(T)) {
        T x, y;
        std::memcpy(&x, &a[i], sizeof x);
        std::memcpy(&y, &b[i], sizeof y);
        greatest = std::max(greatest, std::abs(int(x) - int(y)));
    }
    return greatest;
}

// Those of the library are within one unit in the last place, as the extension allows.
TEST(MeshoptFilters, AgreeWithTheLibrary) {
    constexpr size_t count = 1000;
    const std::vector<float> vectors = unit_vectors(count);
    Bytes eight(4 * count), sixteen(8 * count), quaternions(8 * count);
    meshopt_encodeFilterOct(eight.data(), count, 4, 8, vectors.data());
    meshopt_encodeFilterOct(sixteen.data(), count, 8, 12, vectors.data());
    meshopt_encodeFilterQuat(quaternions.data(), count, 8, 14, vectors.data());
    const auto compare = [&](const Bytes& encoded, auto ours, auto theirs, auto type) {
        Bytes a = encoded, b = encoded;
        ours(a);
        theirs(b.data(), count, b.size() / count);
        EXPECT_NE(a, encoded);
        return difference<decltype(type)>(a, b);
    };
    EXPECT_LE(compare(eight, filter_octahedral_8, meshopt_decodeFilterOct, int8_t{}), 1);
    EXPECT_LE(compare(sixteen, filter_octahedral_16, meshopt_decodeFilterOct, int16_t{}), 1);
    EXPECT_LE(compare(quaternions, filter_quaternion, meshopt_decodeFilterQuat, int16_t{}), 1);

    Bytes exponents(16 * count);
#if MESHOPTIMIZER_VERSION > 180  // which encodes so without being asked
    meshopt_encodeFilterExp(exponents.data(), count, 16, 15, vectors.data(),
                            meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(exponents.data(), count, 16, 15, vectors.data());
#endif
    Bytes ours = exponents, theirs = exponents;
    filter_exponential(ours);
    meshopt_decodeFilterExp(theirs.data(), count, 16);
    EXPECT_EQ(ours, theirs);
}

TEST(MeshoptFilters, GiveUnitVectorsBack) {
    const std::vector<float> vectors = unit_vectors(500);
    Bytes bytes(8 * 500);
    meshopt_encodeFilterQuat(bytes.data(), 500, 8, 16, vectors.data());
    filter_quaternion(bytes);
    for (size_t i = 0; i < 500; ++i) {
        float cosine = 0;  // of half the angle between both: q and -q are one rotation
        for (size_t k = 0; k < 4; ++k) {
            int16_t value;
            std::memcpy(&value, &bytes[8 * i + 2 * k], 2);
            cosine += value / 32767.f * vectors[4 * i + k];
        }
        EXPECT_NEAR(std::fabs(cosine), 1, 1e-4);
    }
}

TEST(MeshoptFilters, LeaveRubbishInBounds) {
    std::mt19937 random(9);
    for (const auto filter :
         {MeshoptFilter::Octahedral, MeshoptFilter::Quaternion, MeshoptFilter::Exponential}) {
        Bytes rubbish(8 * 1000);
        for (size_t i = 64; i < rubbish.size(); ++i) rubbish[i] = uint8_t(random());
        const auto stream = test::encode_attributes(rubbish, 8);
        EXPECT_EQ(decoded_stream(attributes_layout(1000, 8, filter), stream).size(),
                  rubbish.size());
    }
}

}  // namespace
}  // namespace petzval::io
