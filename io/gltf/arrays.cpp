// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/arrays.h"

#include <tiny_gltf.h>

#include <functional>

#include "io/gltf/validate/accessor.h"

namespace petzval {
namespace {

/// Elements in a buffer: first address, stride in bytes, count.
struct Elements {
    const uint8_t* first = nullptr;
    size_t stride = 0, count = 0;
};

/// Decodes into rows of `row` numbers each, element i into row slot(i).
template <class T, class Number, class Slot>
void decode(const Elements& from, int width, bool normalized, Number* to, int row, Slot slot) {
    if constexpr (std::is_same_v<T, Number> && std::is_same_v<Slot, std::identity>) {
        if (width == row && from.stride == width * sizeof(T)) {
            std::memcpy(to, from.first, from.count * from.stride);
            return;
        }
    }
    for (size_t i = 0; i < from.count; ++i) {
        const uint8_t* element = from.first + i * from.stride;
        Number* out = to + slot(i) * row;
        for (int k = 0; k < width; ++k)
            out[k] = component_value<Number>(load<T>(element + k * sizeof(T)), normalized);
    }
}

class Reader {
  public:
    Reader(const GltfModel& gltf, int index)
        : gltf_(gltf),
          accessor_(gltf.typed.accessors.at(static_cast<size_t>(index))),
          width_(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor_.type))) {}

    [[nodiscard]] size_t count() const { return accessor_.count; }
    [[nodiscard]] int width() const { return width_; }

    /// Fills rows of `row` numbers each. They must hold what an undefined element reads as.
    template <class Number>
    void read(Number* to, int row) const {
        if (accessor_.bufferView >= 0) {
            const size_t stride =
                gltf_.typed.bufferViews[static_cast<size_t>(accessor_.bufferView)].byteStride;
            decode_as(elements(accessor_.bufferView, accessor_.byteOffset, accessor_.count,
                               element_size(), stride),
                      to, row, std::identity{});
        }
        if (accessor_.sparse.isSparse) read_sparse(to, row);
    }

  private:
    [[nodiscard]] size_t element_size() const {
        return static_cast<size_t>(width_) * component_size(accessor_.componentType);
    }

    template <class Number, class Slot>
    void decode_as(const Elements& from, Number* to, int row, Slot slot) const {
        with_component_type(accessor_.componentType, [&](auto type) {
            decode<decltype(type)>(from, width_, accessor_.normalized, to, row, slot);
        });
    }

    template <class Number>
    void read_sparse(Number* to, int row) const {
        const auto& sparse = accessor_.sparse;
        const auto count = static_cast<size_t>(sparse.count);
        const int type = sparse.indices.componentType;
        const Elements indices =
            elements(sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset),
                     count, component_size(type), 0);
        std::vector<uint32_t> slots(count);
        with_component_type(type, [&](auto component) {
            decode<decltype(component)>(indices, 1, false, slots.data(), 1, std::identity{});
        });
        const Elements values =
            elements(sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset), count,
                     element_size(), 0);
        decode_as(values, to, row, [&](size_t i) { return slots[i]; });
    }

    /// Elements in a bufferView; none where its buffer is undefined. stride 0: tightly packed.
    [[nodiscard]] Elements elements(int view_index, size_t offset, size_t count, size_t size,
                                    size_t stride) const {
        const auto& view = gltf_.typed.bufferViews[static_cast<size_t>(view_index)];
        const auto& bytes = gltf_.source.buffers[static_cast<size_t>(view.buffer)];
        if (bytes.empty()) return {};
        return {bytes.data() + view.byteOffset + offset, stride == 0 ? size : stride, count};
    }

    const GltfModel& gltf_;
    const tinygltf::Accessor& accessor_;
    int width_;
};

/// All elements, each a row of numbers; `undefined` is what one reads as that the file leaves out.
template <class Number, class Row>
std::vector<Row> read_rows(const Reader& reader, const Row& undefined) {
    std::vector<Row> rows(reader.count(), undefined);
    reader.read(reinterpret_cast<Number*>(rows.data()), sizeof(Row) / sizeof(Number));
    return rows;
}

}  // namespace

std::vector<V2f> read_vec2(const GltfModel& gltf, int accessor) {
    return read_rows<float>(Reader(gltf, accessor), V2f(0.f));
}

std::vector<V3f> read_vec3(const GltfModel& gltf, int accessor) {
    return read_rows<float>(Reader(gltf, accessor), V3f(0.f));
}

std::vector<V4f> read_vec4(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    return read_rows<float>(reader, V4f(0.f, 0.f, 0.f, reader.width() == 3 ? 1.f : 0.f));
}

std::vector<M44d> read_matrices(const GltfModel& gltf, int accessor) {
    // Columns of a matrix for column vectors, as the file has them, are rows of one for row
    // vectors.
    return read_rows<double>(Reader(gltf, accessor), M44d(0.0));
}

std::vector<uint32_t> read_indices(const GltfModel& gltf, int accessor) {
    return read_rows<uint32_t>(Reader(gltf, accessor), uint32_t{0});
}

std::vector<std::array<uint32_t, 4>> read_joints(const GltfModel& gltf, int accessor) {
    return read_rows<uint32_t>(Reader(gltf, accessor), std::array<uint32_t, 4>{});
}

}  // namespace petzval
