// SPDX-License-Identifier: Apache-2.0
#include "core/scene/scene.h"

#include <algorithm>

#include "core/scene/motion.h"
#include "core/scene/volume_ranks.h"

namespace petzval {
namespace {

bool same_place(const Scene& scene, const TextureSlot& a, const TextureSlot& b) {
    if (!a.present() || !b.present()) return false;
    const Image &one = scene.images[a.image], &other = scene.images[b.image];
    return one.width == other.width && one.height == other.height && a.wrap_u == b.wrap_u &&
           a.wrap_v == b.wrap_v && a.nearest == b.nearest && a.uv_set == b.uv_set &&
           a.u_row == b.u_row && a.v_row == b.v_row;
}

void find_places(const Scene& scene, Material& m) {
    TextureSlot* const slots[] = {&m.base_color_texture, &m.metallic_roughness_texture,
                                  &m.normal_texture, &m.emissive_texture};
    uint8_t number = 0;
    for (TextureSlot* const slot : slots) {
        slot->place = ++number;
        for (const TextureSlot* const before : slots) {
            if (before == slot) break;
            if (same_place(scene, *before, *slot)) slot->place = before->place;
        }
    }
}

template <class Visit>
void each_shape(const Mesh& mesh, Visit visit) {
    visit(mesh.positions);
    for (const MeshStep& step : mesh.steps) visit(step.positions);
}

void extend_box(Box3f& box, const Mesh& mesh) {
    each_shape(mesh, [&](const std::vector<V3f>& positions) {
        for (const auto& triangle : mesh.triangles)
            for (const uint32_t corner : triangle) box.extendBy(positions[corner]);
    });
}

// Adds the corners of an instance's triangles to the bounds. of_mesh: box about those of the mesh.
void extend_bounds(Box3f& bounds, const Scene& scene, uint32_t index, const Box3f& of_mesh) {
    const Instance& instance = scene.instances[index];
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (instance.identity) return extend_box(bounds, mesh);
    if (const auto* const places = places_of(scene, index)) {  // corners run straight between them
        for (const M44f& m : *places) bounds.extendBy(placed_box(of_mesh, m));
        return;
    }
    // There may be millions of instances: most lie within the others.
    const Box3f box = placed_box(of_mesh, instance.to_world);
    if (bounds.intersects(box.min) && bounds.intersects(box.max)) return;
    each_shape(mesh, [&](const std::vector<V3f>& positions) {
        for (const auto& triangle : mesh.triangles)
            for (const uint32_t corner : triangle)
                bounds.extendBy(placed(instance, positions[corner]));
    });
}

}  // namespace

void finish_scene(Scene& scene) {
    for (Material& material : scene.materials) find_places(scene, material);
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        if (const auto* sun = std::get_if<SunLight>(&scene.lights[i]); sun && sun->has_disc())
            scene.sun_discs.push_back(i);
    for (Instance& instance : scene.instances)
        instance.moves |= !scene.meshes[instance.mesh].steps.empty();
    rank_volumes(scene);
    const std::vector<Box3f> boxes = mesh_boxes(scene);
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        extend_bounds(scene.bounds, scene, i, boxes[instance.mesh]);
        if (!emits(scene, instance)) continue;
        instance.first_light = static_cast<int32_t>(scene.lights.size());
        for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
            scene.lights.push_back(TriangleLight{i, triangle});
    }
    if (scene.sky.even()) return;
    scene.sky_light = static_cast<int32_t>(scene.lights.size());
    scene.lights.push_back(SkyLight{});
}

bool emits(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.triangles.empty()) return false;
    const Material& material = scene.materials[mesh.material];
    return material.emits() && !material.unlit;
}

std::vector<Box3f> mesh_boxes(const Scene& scene) {
    std::vector<Box3f> boxes(scene.meshes.size());
    for (const Instance& instance : scene.instances) {
        Box3f& box = boxes[instance.mesh];
        if (instance.identity || !box.isEmpty()) continue;
        extend_box(box, scene.meshes[instance.mesh]);
    }
    return boxes;
}

Box3f placed_box(const Box3f& box, const M44f& to_world) {
    constexpr float rounding = 1e-6f;  // of the sum of what is added, and more than it takes
    Box3f out;
    for (int i = 0; i < 3; ++i) {
        float low = to_world[3][i], high = low, most = std::fabs(low);
        for (int j = 0; j < 3; ++j) {
            const float a = box.min[j] * to_world[j][i], b = box.max[j] * to_world[j][i];
            low += std::min(a, b);
            high += std::max(a, b);
            most += std::max(std::fabs(a), std::fabs(b));
        }
        out.min[i] = low - most * rounding;
        out.max[i] = high + most * rounding;
    }
    return out;
}

}  // namespace petzval
