// SPDX-License-Identifier: Apache-2.0
// A lamp of one triangle, for tests of lights.
#pragma once

#include "core/scene/scene.h"

namespace petzval::test {

/// Front side towards -y: seen from below, a, b, c run counter-clockwise.
inline constexpr std::array<std::array<float, 3>, 3> kLampCorners{
    {{-0.5f, 2.f, -0.4f}, {1.1f, 2.2f, 0.1f}, {0.2f, 1.7f, 1.3f}}};

[[nodiscard]] inline Mesh one_triangle(const V3f& a, const V3f& b, const V3f& c,
                                       uint32_t material = 0) {
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    mesh.uv[0] = {V2f(0, 0), V2f(1, 0), V2f(0, 1)};
    mesh.material = material;
    return mesh;
}

[[nodiscard]] inline Material glowing(Rgb nits, bool double_sided = false) {
    Material material;
    material.emissive = nits;
    material.double_sided = double_sided;
    return material;
}

[[nodiscard]] inline Instance placed(uint32_t mesh, const M44f& to_world) {
    Instance instance;
    instance.mesh = mesh;
    instance.identity = false;
    instance.to_world = to_world;
    instance.to_local = linear_part(to_world.inverse());
    instance.flips = to_world.determinant() < 0;
    return instance;
}

/// A lamp above the origin, one-sided, shining down; not yet finished.
[[nodiscard]] inline Scene lamp_scene(Rgb nits = Rgb(5.f, 3.f, 1.f), bool double_sided = false) {
    const auto corner = [](int i) {
        return V3f(kLampCorners[i][0], kLampCorners[i][1], kLampCorners[i][2]);
    };
    Scene scene;
    scene.materials = {glowing(nits, double_sided)};
    scene.meshes = {one_triangle(corner(0), corner(1), corner(2))};
    scene.instances.resize(1);
    return scene;
}

}  // namespace petzval::test
