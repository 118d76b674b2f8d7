// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/accessor.h"

#include <functional>

namespace petzval::io {
namespace {

/// Decodes `count` elements that begin `stride` bytes apart, element i into row slot(i).
template <class Number, class Slot>
void decode(const GltfAccessor& accessor, const uint8_t* first, size_t stride, uint64_t count,
            Number* to, size_t row, Slot slot) {
    const auto width = static_cast<size_t>(accessor.components);
    with_component_type(accessor.component_type, [&](auto component) {
        using T = decltype(component);
        if constexpr (std::is_same_v<T, Number> && std::is_same_v<Slot, std::identity>)
            if (width == row && stride == width * sizeof(T)) {
                std::memcpy(to, first, count * stride);
                return;
            }
        for (uint64_t i = 0; i < count; ++i)
            for (size_t k = 0; k < width; ++k)
                to[slot(i) * row + k] = component_value<Number>(
                    load<T>(first + i * stride + k * sizeof(T)), accessor.normalized);
    });
}

template <class Number>
void replace_sparse(const GltfAccessor& accessor, Number* to, size_t row) {
    const GltfSparse& sparse = *accessor.sparse;
    const std::vector<uint32_t> slots = indices_of(sparse);
    const size_t size = element_size(accessor.type, accessor.component_type, true);
    const std::vector<uint8_t> zeros(sparse.values.empty() ? size : 0);
    const bool none = sparse.values.empty();
    decode(accessor, none ? zeros.data() : sparse.values.data(), none ? 0 : size, sparse.count, to,
           row, [&](uint64_t i) { return size_t{slots[i]}; });
}

}  // namespace

size_t component_size(int component_type) {
    switch (component_type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

int component_count(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

size_t element_size(const std::string& type, int component_type, bool padded) {
    const size_t size = component_size(component_type);
    if (!type.starts_with("MAT")) return size_t(component_count(type)) * size;
    const size_t columns = size_t(type.back() - '0'), column = columns * size;
    const size_t column_stride = (column + 3) / 4 * 4;
    return (columns - 1) * column_stride + (padded ? column_stride : column);
}

template <class Number>
void read_rows(const GltfAccessor& accessor, Number* to, size_t row) {
    if (!accessor.bytes.empty())
        decode(accessor, accessor.bytes.data(), accessor.stride, accessor.count, to, row,
               std::identity{});
    if (accessor.sparse) replace_sparse(accessor, to, row);
}

std::vector<uint32_t> indices_of(const GltfSparse& sparse) {
    GltfAccessor list;
    list.component_type = sparse.index_component_type;
    list.components = 1;
    list.count = sparse.count;
    list.stride = component_size(sparse.index_component_type);
    list.bytes = sparse.indices;
    return read_all<uint32_t>(list);
}

template void read_rows(const GltfAccessor&, float*, size_t);
template void read_rows(const GltfAccessor&, double*, size_t);
template void read_rows(const GltfAccessor&, uint32_t*, size_t);

}  // namespace petzval::io
