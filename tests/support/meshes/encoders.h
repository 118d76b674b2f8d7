// SPDX-License-Identifier: Apache-2.0
// Compressed meshes for tests, made with the encoders of the libraries that decode them.
#pragma once

#include <draco/compression/encode.h>
#include <draco/core/encoder_buffer.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <vector>

namespace petzval::test {

template <class T>
std::span<const uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
}

/// A bumpy square of n by n points with normals, texture coordinates and colours: smooth, so that
/// codecs predict it, and of no symmetry, so that what is swapped is seen.
struct Grid {
    explicit Grid(uint32_t n) {
        for (uint32_t y = 0; y < n; ++y)
            for (uint32_t x = 0; x < n; ++x) {
                const float u = float(x) / float(n), v = float(y) / float(n);
                positions.insert(positions.end(), {u, v, 0.1f * std::sin(9 * u + 5 * v)});
                const float nx = -0.9f * std::cos(9 * u + 5 * v), ny = nx * 5 / 9;
                const float length = std::sqrt(nx * nx + ny * ny + 1);
                normals.insert(normals.end(), {nx / length, ny / length, 1 / length});
                uv.insert(uv.end(), {u * u, v});
                colours.insert(colours.end(),
                               {uint8_t(x * 3), uint8_t(y * 5), uint8_t(x ^ y), 255});
            }
        for (uint32_t y = 0; y + 1 < n; ++y)
            for (uint32_t x = 0; x + 1 < n; ++x) {
                const uint32_t a = y * n + x, b = a + 1, c = a + n, d = c + 1;
                indices.insert(indices.end(), {a, b, c, b, d, c});
            }
    }

    [[nodiscard]] uint32_t points() const { return uint32_t(positions.size() / 3); }

    std::vector<float> positions, normals, uv;
    std::vector<uint8_t> colours;
    std::vector<uint32_t> indices;
};

/// A stream of the mode ATTRIBUTES.
inline std::vector<uint8_t> encode_attributes(std::span<const uint8_t> elements, size_t stride) {
    const size_t count = elements.size() / stride;
    std::vector<uint8_t> stream(meshopt_encodeVertexBufferBound(count, stride));
    stream.resize(
        meshopt_encodeVertexBuffer(stream.data(), stream.size(), elements.data(), count, stride));
    return stream;
}

/// A stream of the mode TRIANGLES, which may turn triangles.
inline std::vector<uint8_t> encode_triangles(const std::vector<uint32_t>& indices,
                                             size_t vertices) {
    std::vector<uint8_t> stream(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    stream.resize(
        meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
    return stream;
}

/// A stream of the mode INDICES.
inline std::vector<uint8_t> encode_indices(const std::vector<uint32_t>& indices, size_t vertices) {
    std::vector<uint8_t> stream(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    stream.resize(
        meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), indices.size()));
    return stream;
}

/// A mesh for Draco's encoder. Attributes get the ids 0, 1, 2 ... in the order of the calls.
class DracoBuilder {
  public:
    DracoBuilder(uint32_t points, const std::vector<uint32_t>& indices) {
        mesh_.set_num_points(points);
        for (size_t i = 0; i < indices.size(); i += 3)
            mesh_.AddFace({draco::PointIndex(indices[i]), draco::PointIndex(indices[i + 1]),
                           draco::PointIndex(indices[i + 2])});
    }

    template <class T>
    DracoBuilder& add(draco::GeometryAttribute::Type kind, draco::DataType type,
                      const std::vector<T>& values, bool normalized = false) {
        const uint32_t points = mesh_.num_points();
        const size_t width = values.size() / points;
        draco::GeometryAttribute attribute;
        attribute.Init(kind, nullptr, uint8_t(width), type, normalized, int64_t(width * sizeof(T)),
                       0);
        const int id = mesh_.AddAttribute(attribute, true, points);
        for (uint32_t i = 0; i < points; ++i)
            mesh_.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                   &values[i * width]);
        return *this;
    }

    [[nodiscard]] draco::Mesh& mesh() { return mesh_; }

    /// bits: quantization of positions, normals and texture coordinates; 0 for none.
    [[nodiscard]] std::vector<uint8_t> encode(draco::MeshEncoderMethod method, int bits = 0,
                                              int speed = 5) const {
        draco::Encoder encoder;
        encoder.SetEncodingMethod(method);
        encoder.SetSpeedOptions(speed, speed);
        for (const auto kind :
             {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
              draco::GeometryAttribute::TEX_COORD})
            encoder.SetAttributeQuantization(kind, bits);
        draco::EncoderBuffer buffer;
        if (!encoder.EncodeMeshToBuffer(mesh_, &buffer).ok())
            throw std::runtime_error("Draco cannot encode a mesh of the tests");
        return {buffer.data(), buffer.data() + buffer.size()};
    }

  private:
    draco::Mesh mesh_;
};

/// A Draco mesh of a grid: positions, normals, texture coordinates, colours.
struct DracoGrid : DracoBuilder {
    explicit DracoGrid(const Grid& grid) : DracoBuilder(grid.points(), grid.indices) {
        using Attribute = draco::GeometryAttribute;
        add(Attribute::POSITION, draco::DT_FLOAT32, grid.positions);
        add(Attribute::NORMAL, draco::DT_FLOAT32, grid.normals);
        add(Attribute::TEX_COORD, draco::DT_FLOAT32, grid.uv);
        add(Attribute::COLOR, draco::DT_UINT8, grid.colours, true);
    }
};

}  // namespace petzval::test
