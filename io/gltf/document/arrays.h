// SPDX-License-Identifier: Apache-2.0
// Accessors of a glTF file, decoded to arrays: strides, component types, sparse values.
#pragma once

#include <array>
#include <vector>

#include "core/math/math.h"
#include "io/gltf/document/model.h"

namespace petzval::io {

/// The accessor of an index, with its format and its bytes.
[[nodiscard]] const GltfAccessor& accessor_of(const GltfModel&, int accessor);

/// The readers below decode the accessor of that index. Integers become floats, normalised ones as
/// glTF 2.0, section 3.11 has it; elements that the file leaves undefined are 0; sparse values are
/// in place. That the accessor has the shape asked for was checked when the file was read.
[[nodiscard]] std::vector<V2f> read_vec2(const GltfModel&, int accessor);
[[nodiscard]] std::vector<V3f> read_vec3(const GltfModel&, int accessor);
/// Reads VEC4, or VEC3 with a fourth component of 1.
[[nodiscard]] std::vector<V4f> read_vec4(const GltfModel&, int accessor);
/// Reads MAT4 of floats, in Imath's convention of row vectors.
[[nodiscard]] std::vector<M44d> read_matrices(const GltfModel&, int accessor);
/// Reads SCALAR of an unsigned integer: vertex numbers.
[[nodiscard]] std::vector<uint32_t> read_indices(const GltfModel&, int accessor);
/// Reads VEC4 of unsigned integers: joints of a skin.
[[nodiscard]] std::vector<std::array<uint32_t, 4>> read_joints(const GltfModel&, int accessor);

}  // namespace petzval::io
