// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "io/gltf/compression/draco_mesh.h"
#include "tests/support/meshes/encoders.h"

namespace petzval::io {
namespace {

using test::Grid;
using Bytes = std::vector<uint8_t>;

constexpr int kFloat = 5126, kByte = 5121;
const std::array<DracoArray, 4> kAll = {
    {{0, kFloat, 3}, {1, kFloat, 3}, {2, kFloat, 2}, {3, kByte, 4}}};

DracoMesh decoded(const Bytes& stream, uint64_t vertices, std::span<const DracoArray> arrays) {
    const DracoHeader header = read_draco_header(stream);
    EXPECT_EQ(header.fault, "");
    return decode_draco(stream, header, vertices, arrays);
}

template <class T>
std::vector<T> values(const Bytes& bytes) {
    std::vector<T> out(bytes.size() / sizeof(T));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

TEST(Draco, SequentialGivesTheNumbersBack) {
    const Grid grid(21);
    const Bytes stream = test::DracoGrid(grid).encode(draco::MESH_SEQUENTIAL_ENCODING);
    const DracoMesh mesh = decoded(stream, grid.points(), kAll);
    ASSERT_EQ(mesh.fault, "");
    EXPECT_EQ(values<uint32_t>(mesh.indices), grid.indices);
    EXPECT_EQ(values<float>(mesh.arrays[0]), grid.positions);
    EXPECT_EQ(values<float>(mesh.arrays[1]), grid.normals);
    EXPECT_EQ(values<float>(mesh.arrays[2]), grid.uv);
    EXPECT_EQ(mesh.arrays[3], grid.colours);
}

/// Corners of all triangles with position, normal, texture coordinates and colour, sorted: what
/// does not depend on the order of vertices and triangles.
using Corner = std::array<float, 12>;
std::vector<std::array<Corner, 3>> corners(const std::vector<uint32_t>& indices,
                                           const std::vector<float>& p, const std::vector<float>& n,
                                           const std::vector<float>& uv, const Bytes& c) {
    std::vector<std::array<Corner, 3>> out;
    for (size_t i = 0; i < indices.size(); i += 3) {
        std::array<Corner, 3> triangle;
        for (size_t k = 0; k < 3; ++k) {
            const size_t v = indices[i + k];
            triangle[k] = {
                p[3 * v],        p[3 * v + 1],        p[3 * v + 2],        n[3 * v],
                n[3 * v + 1],    n[3 * v + 2],        uv[2 * v],           uv[2 * v + 1],
                float(c[4 * v]), float(c[4 * v + 1]), float(c[4 * v + 2]), float(c[4 * v + 3])};
        }
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
        out.push_back(triangle);
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(Draco, EdgebreakerGivesTheTrianglesBack) {
    const Grid grid(21);
    for (const int speed : {0, 5, 10}) {
        const Bytes stream =
            test::DracoGrid(grid).encode(draco::MESH_EDGEBREAKER_ENCODING, 0, speed);
        const DracoMesh mesh = decoded(stream, grid.points(), kAll);
        ASSERT_EQ(mesh.fault, "");
        EXPECT_EQ(
            corners(values<uint32_t>(mesh.indices), values<float>(mesh.arrays[0]),
                    values<float>(mesh.arrays[1]), values<float>(mesh.arrays[2]), mesh.arrays[3]),
            corners(grid.indices, grid.positions, grid.normals, grid.uv, grid.colours));
    }
}

/// A grid whose triangles share no vertex, each with texture coordinates of its own.
Grid split(const Grid& grid) {
    Grid out(0);
    for (const uint32_t v : grid.indices) {
        const float shift = float(out.indices.size() / 3 % 7);
        out.positions.insert(out.positions.end(), &grid.positions[3 * v],
                             &grid.positions[3 * v] + 3);
        out.normals.insert(out.normals.end(), &grid.normals[3 * v], &grid.normals[3 * v] + 3);
        out.uv.insert(out.uv.end(), {grid.uv[2 * v] + shift, grid.uv[2 * v + 1]});
        out.colours.insert(out.colours.end(), &grid.colours[4 * v], &grid.colours[4 * v] + 4);
        out.indices.push_back(uint32_t(out.indices.size()));
    }
    return out;
}

TEST(Draco, EdgebreakerKeepsSeams) {
    const Grid grid = split(Grid(9));
    for (const int speed : {0, 5, 10}) {
        test::DracoGrid builder(grid);
        builder.mesh().DeduplicateAttributeValues();  // so that it is one surface with seams
        builder.mesh().DeduplicatePointIds();
        const Bytes stream = builder.encode(draco::MESH_EDGEBREAKER_ENCODING, 0, speed);
        const DracoMesh mesh = decoded(stream, grid.points(), kAll);
        ASSERT_EQ(mesh.fault, "");
        EXPECT_EQ(
            corners(values<uint32_t>(mesh.indices), values<float>(mesh.arrays[0]),
                    values<float>(mesh.arrays[1]), values<float>(mesh.arrays[2]), mesh.arrays[3]),
            corners(grid.indices, grid.positions, grid.normals, grid.uv, grid.colours));
    }
}

TEST(Draco, QuantizedPositionsAreWithinHalfAStep) {
    const Grid grid(21);
    const Bytes stream = test::DracoGrid(grid).encode(draco::MESH_SEQUENTIAL_ENCODING, 10);
    const DracoMesh mesh = decoded(stream, grid.points(), kAll);
    ASSERT_EQ(mesh.fault, "");
    const auto positions = values<float>(mesh.arrays[0]);
    EXPECT_NE(positions, grid.positions);
    for (size_t i = 0; i < positions.size(); ++i)
        EXPECT_NEAR(positions[i], grid.positions[i], 0.5 * 1 / 1023);
}

TEST(Draco, ConvertsToTheFormatOfTheAccessor) {
    const Grid grid(5);
    std::vector<uint32_t> joints(4 * grid.points());
    for (size_t i = 0; i < joints.size(); ++i) joints[i] = uint32_t(3 * i);
    test::DracoBuilder builder(grid.points(), grid.indices);
    builder.add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, grid.positions)
        .add(draco::GeometryAttribute::GENERIC, draco::DT_UINT32, joints)
        .add(draco::GeometryAttribute::COLOR, draco::DT_UINT8, grid.colours, true);
    const Bytes stream = builder.encode(draco::MESH_SEQUENTIAL_ENCODING);
    const std::array<DracoArray, 2> wanted = {{{1, 5123, 4}, {2, kFloat, 4}}};
    const DracoMesh mesh = decoded(stream, grid.points(), wanted);
    ASSERT_EQ(mesh.fault, "");
    EXPECT_EQ(values<uint16_t>(mesh.arrays[0]),
              std::vector<uint16_t>(joints.begin(), joints.end()));
    EXPECT_EQ(values<float>(mesh.arrays[1])[4], grid.colours[4] / 255.f);

    const std::array<DracoArray, 1> small = {{{1, kByte, 4}}};  // 256 and more do not fit
    EXPECT_NE(decoded(stream, grid.points(), small).fault, "");
    const std::array<DracoArray, 1> narrow = {{{0, kFloat, 2}}}, absent = {{{7, kFloat, 3}}};
    EXPECT_NE(decoded(stream, grid.points(), narrow).fault, "");
    EXPECT_NE(decoded(stream, grid.points(), absent).fault, "");
}

TEST(Draco, SkipsMetadata) {
    const Grid grid(5);
    test::DracoGrid builder(grid);
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    auto below = std::make_unique<draco::Metadata>(), deeper = std::make_unique<draco::Metadata>();
    deeper->AddEntryDouble("number", 3);
    below->AddSubMetadata("deeper", std::move(deeper));
    metadata->AddEntryString("author", std::string(300, 'x'));
    metadata->AddSubMetadata("below", std::move(below));
    metadata->AddSubMetadata("beside", std::make_unique<draco::Metadata>());
    auto of_attribute = std::make_unique<draco::AttributeMetadata>();
    of_attribute->AddEntryInt("unit", 5);
    builder.mesh().AddMetadata(std::move(metadata));
    builder.mesh().AddAttributeMetadata(0, std::move(of_attribute));
    for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Bytes stream = builder.encode(method);
        ASSERT_EQ(stream[10], 0x80);
        const DracoHeader header = read_draco_header(stream);
        EXPECT_EQ(header.faces, 32u);
        EXPECT_GT(header.body, 300u);
        EXPECT_EQ(decoded(stream, grid.points(), kAll).fault, "");
    }
}

TEST(DracoHeader, TellsTheFaces) {
    const Grid grid(21);
    for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const DracoHeader header = read_draco_header(test::DracoGrid(grid).encode(method));
        EXPECT_EQ(header.faces, 800u);
        EXPECT_EQ(header.body, kDracoHeaderBytes);
    }
}

TEST(DracoHeader, RefusesOtherStreams) {
    const Grid grid(5);
    const Bytes sound = test::DracoGrid(grid).encode(draco::MESH_EDGEBREAKER_ENCODING);
    const auto with = [&](size_t at, uint8_t value) {
        Bytes stream = sound;
        stream[at] = value;
        return read_draco_header(stream).fault;
    };
    EXPECT_NE(with(0, 'd').find("no Draco stream"), std::string::npos);
    EXPECT_NE(with(5, 1).find("not of version 2.2"), std::string::npos);
    EXPECT_NE(with(6, 1).find("not of version 2.2"), std::string::npos);
    EXPECT_NE(with(7, 0).find("cloud of points"), std::string::npos);
    EXPECT_NE(with(8, 2).find("unknown way"), std::string::npos);
    EXPECT_NE(with(11, 1).find("no longer in use"), std::string::npos);  // predictive edgebreaker
    for (const size_t size : {0u, 5u, 10u, 12u})
        EXPECT_NE(read_draco_header({sound.data(), size}).fault, "");
    EXPECT_NE(read_draco_header(Bytes(100, 0xff)).fault, "");
}

/// A header of an edgebreaker stream that announces so much, with rubbish behind it.
Bytes announcing(uint32_t vertices, uint32_t faces, uint8_t seams) {
    Bytes stream = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0, 0};
    for (uint32_t number : {vertices, faces}) {
        for (; number >= 128; number >>= 7) stream.push_back(uint8_t(number | 128));
        stream.push_back(uint8_t(number));
    }
    stream.push_back(seams);
    stream.resize(stream.size() + 100, 1);
    return stream;
}

TEST(DracoHeader, RefusesWhatWouldFillTheMemory) {
    EXPECT_EQ(read_draco_header(announcing(100, 100, 3)).fault, "");
    EXPECT_EQ(read_draco_header(announcing(1'000'000, 1'000'000, 2)).fault, "");
    EXPECT_NE(read_draco_header(announcing(1'000'000, 1'000'000, 200)).fault, "");
    EXPECT_NE(read_draco_header(announcing(100'000'000, 100'000'000, 0)).fault, "");
    EXPECT_NE(read_draco_header(announcing(4'000'000'000, 100, 0)).fault, "");
}

TEST(Draco, RefusesMoreVerticesThanTheMost) {
    const Grid grid(5);
    for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Bytes stream = test::DracoGrid(grid).encode(method);
        EXPECT_EQ(decoded(stream, grid.points(), kAll).vertices, grid.points());
        EXPECT_NE(decoded(stream, grid.points() - 1, kAll).fault.find("too many vertices"),
                  std::string::npos);
    }
}

// A number of orientations of texture coordinates that would take seconds and 256 MiB.
TEST(Draco, RefusesMoreOrientationsThanCorners) {
    const Grid grid(21);
    Bytes stream = test::DracoGrid(grid).encode(draco::MESH_EDGEBREAKER_ENCODING, 10, 0);
    ASSERT_EQ(decoded(stream, grid.points(), kAll).fault, "");
    // It stands before the bits, whose number is the size of a whole grid's at most.
    int refused = 0;
    for (size_t at = 0; at + 4 <= stream.size(); ++at) {
        uint32_t number;
        std::memcpy(&number, &stream[at], 4);
        if (number < 200 || number > grid.points()) continue;
        Bytes hostile = stream;
        hostile[at + 3] = 0x7f;
        const auto start = std::chrono::steady_clock::now();
        refused += !decoded(hostile, grid.points(), kAll).fault.empty();
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    }
    EXPECT_GT(refused, 0);
}

// 4000 attributes of 255 doubles for each of 40000 vertices would take 300 GB.
TEST(Draco, RefusesAttributesThatWouldFillTheMemory) {
    const Grid grid(200);
    test::DracoBuilder builder(grid.points(), grid.indices);
    builder.add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, grid.positions);
    Bytes stream = builder.encode(draco::MESH_SEQUENTIAL_ENCODING);
    // Where the one attribute is described: a decoder's number of attributes, then kind, type,
    // components, normalized, id; then the way it is encoded.
    const Bytes described = {1, 0, draco::DT_FLOAT32, 3, 0, 0, 0};
    const auto at = std::search(stream.begin(), stream.end(), described.begin(), described.end());
    ASSERT_NE(at, stream.end());
    Bytes hostile(stream.begin(), at);
    hostile.insert(hostile.end(), {0xa0, 0x1f});
    for (int i = 0; i < 4000; ++i)
        hostile.insert(hostile.end(), {4, draco::DT_FLOAT64, 255, 0, uint8_t(i % 128)});
    hostile.insert(hostile.end(), 4000, 0);
    hostile.insert(hostile.end(), 100000, 0);
    EXPECT_NE(decoded(hostile, grid.points(), kAll).fault.find("too short for its attributes"),
              std::string::npos);
}

}  // namespace
}  // namespace petzval::io
