// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/world.h"

namespace petzval::stability {

Mesh quad(V3f corner, V3f a, V3f b) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

Mesh box(V3f low, V3f high) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                                    i & 4 ? high.z : low.z);
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

Mesh ball(V3f centre, float radius) {
    constexpr int kRows = 24, kColumns = 2 * kRows;
    Mesh mesh;
    for (int i = 0; i <= kRows; ++i)
        for (int j = 0; j < kColumns; ++j) {
            const float theta = kPi * static_cast<float>(i) / kRows;
            const float phi = 2 * kPi * static_cast<float>(j) / kColumns;
            mesh.positions.push_back(centre + V3f(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                  -std::sin(theta) * std::sin(phi)) *
                                                  radius);
        }
    const auto at = [](int i, int j) { return static_cast<uint32_t>(i * kColumns + j % kColumns); };
    for (int i = 0; i < kRows; ++i)
        for (int j = 0; j < kColumns; ++j) {
            if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < kRows)
                mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    return mesh;
}

Material diffuse(float albedo) {
    Material m;
    m.base_color = Rgb(albedo);
    m.metallic = 0;
    m.specular = 0;
    m.double_sided = true;
    return m;
}

Material glowing(float nits) {
    Material m = diffuse(0);
    m.emissive = Rgb(nits);
    return m;
}

Material clear_glass(float ior, float attenuation) {
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.ior = ior;
    m.transmission = 1;
    m.has_volume = true;
    m.attenuation_color = Rgb(attenuation);
    m.attenuation_distance_m = 1;
    return m;
}

void World::place(Mesh mesh, const Material& material) {
    mesh.material = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
}

void World::finish() {
    finish_scene(scene);
    bvh = std::make_unique<Bvh>(scene, Traversal::Robust);
    lights = std::make_unique<LightChoice>(scene, LightChoiceKind::Power);
}

World lamp_ahead(double side_m, double distance_m) {
    World world;
    const auto a = static_cast<float>(side_m);
    world.place(quad(V3f(-a / 2, -a / 2, -float(distance_m)), V3f(a, 0, 0), V3f(0, a, 0)),
                glowing(1));
    world.finish();
    return world;
}

}  // namespace petzval::stability
