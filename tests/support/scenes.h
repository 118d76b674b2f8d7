// SPDX-License-Identifier: Apache-2.0
// Scenes made of code, for tests of the renderer itself.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"

namespace petzval::test {

/// A material that is one thing only: rough, not metallic.
inline Material diffuse_material(float albedo) {
    Material m;
    m.base_color = Rgb(albedo);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    m.double_sided = true;
    return m;
}

inline Material emitter_material(float radiance, float albedo = 0.f) {
    Material m = diffuse_material(albedo);
    m.emissive = Rgb(radiance);
    return m;
}

/// Latitude-longitude sphere; rows >= 2. Normals point outward, smooth normals on demand.
inline Mesh sphere(V3f centre, float radius, int rows, bool smooth) {
    Mesh mesh;
    const int columns = 2 * rows;
    for (int i = 0; i <= rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const float theta = kPi * static_cast<float>(i) / static_cast<float>(rows);
            const float phi = 2 * kPi * static_cast<float>(j) / static_cast<float>(columns);
            const V3f n(std::sin(theta) * std::cos(phi), std::cos(theta),
                        -std::sin(theta) * std::sin(phi));
            mesh.positions.push_back(centre + n * radius);
            if (smooth) mesh.normals.push_back(n);
        }
    }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * columns + j % columns); };
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < rows)
                mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    }
    return mesh;
}

/// A parallelogram corner + s*a + t*b; the front is where cross(a, b) points.
inline Mesh quad(V3f corner, V3f a, V3f b) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.uv[0] = {V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A closed box, faces outwards, corners of their own for each face.
inline Mesh box(V3f low, V3f high) {
    Mesh mesh;
    const V3f size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    const std::array<V3f, 3> faces[] = {{low, y, x},    {low, z, y},    {low, x, z},
                                        {high, -x, -y}, {high, -y, -z}, {high, -z, -x}};
    for (const auto& [corner, a, b] : faces) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const V3f& p : {corner, corner + a, corner + a + b, corner + b})
            mesh.positions.push_back(p);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    return mesh;
}

/// Adds the triangles of another mesh, which has the same attributes.
inline void append(Mesh& to, const Mesh& more) {
    const auto first = static_cast<uint32_t>(to.positions.size());
    const auto join = [](auto& all, const auto& those) {
        all.insert(all.end(), those.begin(), those.end());
    };
    join(to.positions, more.positions);
    join(to.normals, more.normals);
    join(to.tangents, more.tangents);
    for (size_t set = 0; set < to.uv.size(); ++set) join(to.uv[set], more.uv[set]);
    join(to.colours, more.colours);
    for (const auto& [a, b, c] : more.triangles)
        to.triangles.push_back({a + first, b + first, c + first});
}

/// Smooth glass with a volume; attenuation: share of light that is left after a metre.
inline Material glass_material(float ior, float attenuation = 1.f) {
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.ior = ior;
    m.has_volume = true;
    m.attenuation_color = Rgb(attenuation);
    m.attenuation_distance_m = 1;
    return m;
}

/// Puts a mesh with a material of its own into world space.
inline void place(Scene& scene, Mesh mesh, const Material& material) {
    mesh.material = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
}

/// A scene and what a tracer wants beside it.
struct World {
    Scene scene;
    std::unique_ptr<Bvh> bvh;
    std::unique_ptr<LightChoice> lights;

    /// Once all is placed.
    void finish() {
        finish_scene(scene);
        bvh = std::make_unique<Bvh>(scene, Traversal::Robust);
        lights = std::make_unique<LightChoice>(scene, LightChoiceKind::Power);
    }
};

}  // namespace petzval::test
