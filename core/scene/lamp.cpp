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

}  // namespace

void add_lamps(Scene& scene, std::span<const BallLamp> lamps) {
    const Mesh sphere = geodesic_sphere(halvings(lamps.size()));
    // A convex body shows a quarter of its area, on average over all directions (Cauchy 1832).
    const double shown = area(sphere) / 4;
    for (const BallLamp& lamp : lamps) {
        Material material;
        material.base_color = Rgb(0.f);
        material.metallic = 0;
        material.specular = 0;
        material.emissive = lamp.intensity_cd *
                            static_cast<float>(1 / (shown * double(lamp.radius_m) * lamp.radius_m));
        material.illuminant = lamp.illuminant;
        material.beam = lamp.beam;
        Mesh mesh = sphere;
        for (V3f& position : mesh.positions) position = lamp.centre + position * lamp.radius_m;
        mesh.material = static_cast<uint32_t>(scene.materials.size());
        Instance instance;
        instance.mesh = static_cast<uint32_t>(scene.meshes.size());
        scene.materials.push_back(std::move(material));
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back(instance);
    }
}

}  // namespace petzval
