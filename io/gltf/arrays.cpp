// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/arrays.h"

#include <tiny_gltf.h>

#include <cstring>
#include <functional>

#include "io/gltf/validate/accessor.h"

namespace petzval {
namespace {

/// Elements in a buffer: first address, stride in bytes, count.
struct Elements {
    const uint8_t* first = nullptr;
    size_t stride = 0, count = 0;
};

template <class T>
T load(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);  // accessors need not be aligned in memory
    return value;
}

/// Calls visit with a value of the component's C++ type, so that loops are compiled for each.
template <class Visit>
void with_component_type(int component_type, Visit&& visit) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return visit(int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return visit(uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return visit(int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return visit(uint16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return visit(uint32_t{});
        default:
            return visit(float{});
    }
}

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

}  // namespace

std::vector<V2f> read_vec2(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    std::vector<V2f> values(reader.count(), V2f(0.f));
    if (!values.empty()) reader.read(values.front().getValue(), 2);
    return values;
}

std::vector<V3f> read_vec3(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    std::vector<V3f> values(reader.count(), V3f(0.f));
    if (!values.empty()) reader.read(values.front().getValue(), 3);
    return values;
}

std::vector<V4f> read_vec4(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    std::vector<V4f> values(reader.count(), V4f(0.f, 0.f, 0.f, reader.width() == 3 ? 1.f : 0.f));
    if (!values.empty()) reader.read(&values.front().x, 4);
    return values;
}

std::vector<M44d> read_matrices(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    std::vector<M44d> values(reader.count(), M44d(0.0));
    // Columns of a matrix for column vectors, as the file has them, are rows of one for row
    // vectors.
    if (!values.empty()) reader.read(values.front().getValue(), 16);
    return values;
}

std::vector<uint32_t> read_indices(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    std::vector<uint32_t> values(reader.count(), 0u);
    if (!values.empty()) reader.read(values.data(), 1);
    return values;
}

std::vector<std::array<uint32_t, 4>> read_joints(const GltfModel& gltf, int accessor) {
    const Reader reader(gltf, accessor);
    std::vector<std::array<uint32_t, 4>> values(reader.count());
    if (!values.empty()) reader.read(values.front().data(), 4);
    return values;
}

}  // namespace petzval
