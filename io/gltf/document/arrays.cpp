// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/document/arrays.h"

namespace petzval::io {
namespace {

/// All elements, each a row of numbers; `undefined` is what one reads as that the file leaves out.
template <class Number, class Row>
std::vector<Row> read(const GltfAccessor& accessor, const Row& undefined) {
    std::vector<Row> rows(accessor.count, undefined);
    read_rows(accessor, reinterpret_cast<Number*>(rows.data()), sizeof(Row) / sizeof(Number));
    return rows;
}

}  // namespace

const GltfAccessor& accessor_of(const GltfModel& gltf, int accessor) {
    return gltf.source.accessors.at(static_cast<size_t>(accessor));
}

std::vector<V2f> read_vec2(const GltfModel& gltf, int accessor) {
    return read<float>(accessor_of(gltf, accessor), V2f(0.f));
}

std::vector<V3f> read_vec3(const GltfModel& gltf, int accessor) {
    return read<float>(accessor_of(gltf, accessor), V3f(0.f));
}

std::vector<V4f> read_vec4(const GltfModel& gltf, int accessor) {
    const GltfAccessor& from = accessor_of(gltf, accessor);
    return read<float>(from, V4f(0.f, 0.f, 0.f, from.components == 3 ? 1.f : 0.f));
}

std::vector<M44d> read_matrices(const GltfModel& gltf, int accessor) {
    // Columns of a matrix for column vectors, as the file has them, are rows of one for row
    // vectors.
    return read<double>(accessor_of(gltf, accessor), M44d(0.0));
}

std::vector<uint32_t> read_indices(const GltfModel& gltf, int accessor) {
    return read<uint32_t>(accessor_of(gltf, accessor), uint32_t{0});
}

std::vector<std::array<uint32_t, 4>> read_joints(const GltfModel& gltf, int accessor) {
    return read<uint32_t>(accessor_of(gltf, accessor), std::array<uint32_t, 4>{});
}

}  // namespace petzval::io
