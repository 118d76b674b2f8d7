// SPDX-License-Identifier: Apache-2.0
#include "core/scene/lamp.h"

#include "core/scene/geodesic_sphere.h"

namespace petzval {
namespace {

constexpr int kMostHalvings = 3;
constexpr size_t kMostTriangles = size_t{1} << 20;  // of all lamps, where fewer halvings do

// How often a sphere's triangles are parted.
int halvings(size_t lamps) {
    int count = 0;
    while (count < kMostHalvings && geodesic_triangles(count + 1) * lamps <= kMostTriangles)
        ++count;
    return count;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const V3d p(mesh.positions[a]);
        sum += (V3d(mesh.positions[b]) - p).cross(V3d(mesh.positions[c]) - p).length() / 2;
    }
    return sum;
}

M44f moved_to(const V3f& place) {
    M44f matrix;
    matrix.setTranslation(place);
    return matrix;
}

Material lamp_material(Rgb radiance, int32_t illuminant, const std::optional<Beam>& beam,
                       bool unseen) {
    Material material;
    material.base_color = Rgb(0.f);
    material.metallic = 0;
    material.specular = 0;
    material.emissive = radiance;
    material.illuminant = illuminant;
    material.beam = beam;
    material.unseen = unseen;
    return material;
}

// Adds a mesh at its place. steps: places that it moves through; none where it stands still.
void add_lamp(Scene& scene, Mesh mesh, Material material, const M44f& to_world,
              std::vector<M44f> steps) {
    mesh.material = static_cast<uint32_t>(scene.materials.size());
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene.meshes.size());
    if (!steps.empty()) {
        instance.identity = false;
        instance.moves = true;
        instance.to_world = to_world;
        instance.to_local = M33f(linear_part(M44d(instance.to_world)).inverse());
        scene.motion_of.resize(scene.instances.size() + 1, -1);
        scene.motion_of.back() = static_cast<int32_t>(scene.motions.size());
        scene.motions.push_back({std::move(steps)});
    } else {
        for (V3f& position : mesh.positions) position = position * to_world;
    }
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
}

// The flat shape, its front along -z.
Mesh flat_shape(V2f size_m, bool ellipse) {
    constexpr uint32_t corners = 64;
    const V2f half = size_m / 2.f;
    Mesh mesh;
    if (!ellipse) {
        mesh.positions = {
            {-half.x, -half.y, 0}, {-half.x, half.y, 0}, {half.x, half.y, 0}, {half.x, -half.y, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        return mesh;
    }
    const double step = 2 * double(kPi) / corners, wider = std::sqrt(step / std::sin(step));
    mesh.positions.emplace_back(0.f);
    for (uint32_t i = 0; i < corners; ++i) {
        const double x = wider * std::cos(i * step), y = wider * std::sin(i * step);
        mesh.positions.emplace_back(static_cast<float>(x) * half.x, static_cast<float>(y) * half.y,
                                    0.f);
        mesh.triangles.push_back({0, 1 + (i + 1) % corners, 1 + i});
    }
    return mesh;
}

}  // namespace

void add_lamps(Scene& scene, std::span<const BallLamp> lamps) {
    const Mesh sphere = geodesic_sphere(halvings(lamps.size()));
    // A convex body shows a quarter of its area, on average over all directions (Cauchy 1832).
    const double shown = area(sphere) / 4;
    for (const BallLamp& lamp : lamps) {
        const Rgb radiance =
            lamp.intensity_cd *
            static_cast<float>(1 / (shown * double(lamp.radius_m) * lamp.radius_m));
        Mesh mesh = sphere;
        for (V3f& position : mesh.positions) position = position * lamp.radius_m;
        std::vector<M44f> steps;
        for (const V3f& at : lamp.centres) steps.push_back(moved_to(at));
        add_lamp(scene, std::move(mesh),
                 lamp_material(radiance, lamp.illuminant, lamp.beam, lamp.unseen),
                 moved_to(lamp.centre), std::move(steps));
    }
}

void add_lamps(Scene& scene, std::span<const FlatLamp> lamps) {
    for (const FlatLamp& lamp : lamps) {
        const float area_m2 = lamp.size_m.x * lamp.size_m.y * (lamp.ellipse ? kPi / 4 : 1.f);
        add_lamp(scene, flat_shape(lamp.size_m, lamp.ellipse),
                 lamp_material(lamp.intensity_cd * (1.f / area_m2), lamp.illuminant, lamp.beam,
                               lamp.unseen),
                 lamp.to_world, lamp.steps);
    }
}

}  // namespace petzval
