// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/node_place.h"

#include "io/base/json_parse.h"
#include "io/gltf/meshes/matrix.h"

namespace petzval::io {
namespace {

template <class To>
void take(const nlohmann::json& node, const char* key, To& to) {
    const nlohmann::json& numbers = member(node, key);
    for (size_t i = 0; i < numbers.size(); ++i) to[i] = numbers[i].get<double>();
}

}  // namespace

M44d NodePlace::matrix() const {
    M44d out;
    out.setScale(V3d(scale[0], scale[1], scale[2]));
    out = out * rotation_matrix(rotation);
    for (int axis = 0; axis < 3; ++axis) out[3][axis] = translation[static_cast<size_t>(axis)];
    return out;
}

NodePlace stored_place(const nlohmann::json& node) {
    NodePlace place;
    take(node, "translation", place.translation);
    take(node, "rotation", place.rotation);
    take(node, "scale", place.scale);
    return place;
}

M44d stored_matrix(const nlohmann::json& node) {
    if (!node.contains("matrix")) return stored_place(node).matrix();
    std::array<double, 16> numbers{};
    take(node, "matrix", numbers);
    M44d matrix;
    std::copy(numbers.begin(), numbers.end(), &matrix[0][0]);
    return matrix;
}

}  // namespace petzval::io
