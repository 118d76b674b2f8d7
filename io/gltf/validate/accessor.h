// SPDX-License-Identifier: Apache-2.0
// Layout of an accessor's data (glTF 2.0, section 3.6.2), in checked numbers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "io/gltf/mend/attributes.h"

namespace petzval::io {

/// The elements that a sparse accessor replaces.
struct GltfSparse {
    uint64_t count = 0;
    int index_component_type = 0;
    std::span<const uint8_t> indices, values;  ///< tightly packed; empty reads as zeros
};

struct GltfAccessor {
    int component_type = 0;  ///< 5120 int8, 5121 uint8, 5122 int16, 5123 uint16, 5125 uint32, 5126
                             ///< float
    std::string type;        ///< "SCALAR", "VEC3", "MAT4" ...
    int components = 0;      ///< in an element; 0 when the type or component type is unknown
    bool normalized = false;
    uint64_t count = 0;              ///< elements
    size_t stride = 0;               ///< bytes from one element to the next
    std::optional<size_t> view;      ///< its bufferView
    uint64_t offset = 0;             ///< bytes from the start of the bufferView
    std::span<const uint8_t> bytes;  ///< from the first element on; empty reads as zeros
    std::optional<GltfSparse> sparse;
};

/// Format of an accessor's elements.
[[nodiscard]] inline GltfFormat format_of(const GltfAccessor& accessor) {
    return {accessor.component_type, accessor.type, accessor.normalized};
}

/// Bytes of a component; 0 for an unknown type.
[[nodiscard]] size_t component_size(int component_type);

/// Components of a type such as "VEC3"; 0 for an unknown one.
[[nodiscard]] int component_count(const std::string& type);

/// Bytes from the first to behind the last component of an element. The columns of a matrix start
/// at multiples of four bytes; padded: including the bytes behind the last column.
[[nodiscard]] size_t element_size(const std::string& type, int component_type, bool padded);

/// Value of a component as a number: of an integer that is normalised, the share of one that glTF
/// 2.0, section 3.11 gives it.
template <class Number, class T>
[[nodiscard]] Number component_value(T raw, bool normalised) {
    if constexpr (std::is_integral_v<T> && std::is_floating_point_v<Number>) {
        if (normalised)
            return std::max(Number(raw) / Number(std::numeric_limits<T>::max()), Number(-1));
    }
    return static_cast<Number>(raw);
}

/// A number at an address that need not be aligned. glTF is little-endian, and so is every machine
/// that this program is built for.
template <class T>
[[nodiscard]] T load(const uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// Calls visit with a value of the component's C++ type, so that loops are compiled for each.
template <class Visit>
decltype(auto) with_component_type(int component_type, Visit&& visit) {
    switch (component_type) {
        case 5120:
            return visit(int8_t{});
        case 5121:
            return visit(uint8_t{});
        case 5122:
            return visit(int16_t{});
        case 5123:
            return visit(uint16_t{});
        case 5125:
            return visit(uint32_t{});
        default:
            return visit(float{});
    }
}

/// Writes elements, sparse ones replaced and normalised ones as above, to rows of `row` numbers
/// each. They must hold what an undefined element reads as. Number: float, double or uint32_t.
template <class Number>
void read_rows(const GltfAccessor&, Number* to, size_t row);

/// All components of an accessor likewise.
template <class Number>
[[nodiscard]] std::vector<Number> read_all(const GltfAccessor& accessor) {
    const auto width = static_cast<size_t>(accessor.components);
    std::vector<Number> out(accessor.count * width);
    read_rows(accessor, out.data(), width);
    return out;
}

/// Indices of the elements that a sparse accessor replaces.
[[nodiscard]] std::vector<uint32_t> indices_of(const GltfSparse&);

}  // namespace petzval::io
