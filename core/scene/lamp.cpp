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
        const bool moves = !lamp.centres.empty();
        const V3f centre = moves ? V3f(0.f) : lamp.centre;
        for (V3f& position : mesh.positions) position = centre + position * lamp.radius_m;
        mesh.material = static_cast<uint32_t>(scene.materials.size());
        Instance instance;
        instance.mesh = static_cast<uint32_t>(scene.meshes.size());
        if (moves) {
            instance.identity = false;
            instance.moves = true;
            instance.to_world = moved_to(lamp.centre);
            scene.motion_of.resize(scene.instances.size() + 1, -1);
            scene.motion_of.back() = static_cast<int32_t>(scene.motions.size());
            InstanceMotion& motion = scene.motions.emplace_back();
            for (const V3f& at : lamp.centres) motion.to_world.push_back(moved_to(at));
        }
        scene.materials.push_back(std::move(material));
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back(instance);
    }
}

}  // namespace petzval
