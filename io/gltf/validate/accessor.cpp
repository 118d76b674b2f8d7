// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/accessor.h"

namespace petzval {
namespace {

uint32_t load_unsigned(const uint8_t* at, int component_type) {
    if (component_type == 5121) return *at;
    return component_type == 5123 ? load<uint16_t>(at) : load<uint32_t>(at);
}

double load_number(const uint8_t* at, int component_type, bool normalised) {
    return with_component_type(component_type, [&](auto type) {
        return component_value<double>(load<decltype(type)>(at), normalised);
    });
}

/// Calls put(element, address) for every element that has data, sparse ones last.
template <class Put>
void each_element(const GltfAccessor& accessor, Put put) {
    if (!accessor.bytes.empty())
        for (uint64_t i = 0; i < accessor.count; ++i) put(i, &accessor.bytes[i * accessor.stride]);
    if (!accessor.sparse) return;
    const GltfSparse& sparse = *accessor.sparse;
    const size_t index_size = component_size(sparse.index_component_type);
    const size_t size = element_size(accessor.type, accessor.component_type, true);
    const std::vector<uint8_t> zeros(size);
    for (uint64_t i = 0; i < sparse.count; ++i) {
        const uint64_t element =
            sparse.indices.empty()
                ? 0
                : load_unsigned(&sparse.indices[i * index_size], sparse.index_component_type);
        put(element, sparse.values.empty() ? zeros.data() : &sparse.values[i * size]);
    }
}

/// Reads component by component: load_one(address) gives a T.
template <class T, class LoadOne>
std::vector<T> read_all(const GltfAccessor& accessor, LoadOne load_one) {
    const size_t width = size_t(accessor.components);
    const size_t size = component_size(accessor.component_type);
    std::vector<T> out(accessor.count * width);
    each_element(accessor, [&](uint64_t element, const uint8_t* at) {
        for (size_t c = 0; c < width; ++c) out[element * width + c] = load_one(at + c * size);
    });
    return out;
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

std::vector<uint32_t> read_unsigned(const GltfAccessor& accessor) {
    const int type = accessor.component_type;
    return read_all<uint32_t>(accessor,
                              [type](const uint8_t* at) { return load_unsigned(at, type); });
}

std::vector<float> read_floats(const GltfAccessor& accessor) {
    return read_all<float>(accessor, load<float>);
}

std::vector<double> read_numbers(const GltfAccessor& accessor) {
    return read_all<double>(accessor, [&](const uint8_t* at) {
        return load_number(at, accessor.component_type, accessor.normalized);
    });
}

}  // namespace petzval
