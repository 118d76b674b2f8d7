// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/geometry/strokes.h"

#include <tiny_gltf.h>

#include <cmath>

#include "core/scene/geodesic_sphere.h"

namespace petzval::io {
namespace {

/// Sides of a cylinder, and halvings of a sphere's edges: 16 sides and 320 triangles are round at
/// the size of a few pixels, and their normals are smooth.
constexpr uint32_t kSides = 16;
constexpr int kHalvings = 2;
constexpr double kShortest = 1e-3;  ///< cylinder, in radii

Mesh unit_sphere() {
    Mesh mesh = geodesic_sphere(kHalvings);
    mesh.normals = mesh.positions;
    return mesh;
}

// Cylinder of radius 1 along y from 0 to 1, open: spheres close it. Its vertices of even number
// stand at 0.
Mesh unit_cylinder() {
    Mesh mesh;
    for (uint32_t i = 0; i < kSides; ++i) {
        const double angle_rad = 2 * std::acos(-1.) * i / kSides;
        const V3f normal(float(std::cos(angle_rad)), 0, float(-std::sin(angle_rad)));
        for (const float y : {0.f, 1.f}) {
            mesh.positions.push_back(normal + V3f(0, y, 0));
            mesh.normals.push_back(normal);
        }
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
    }
    return mesh;
}

M44d rows(const V3d& x, const V3d& y, const V3d& z, const V3d& origin) {
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

std::vector<std::array<uint32_t, 2>> to_segments(const std::vector<uint32_t>& order, int mode) {
    std::vector<std::array<uint32_t, 2>> segments;
    const size_t step = mode == TINYGLTF_MODE_LINE ? 2 : 1;
    for (size_t i = 0; i + 1 < order.size(); i += step)
        segments.push_back({order[i], order[i + 1]});
    if (mode == TINYGLTF_MODE_LINE_LOOP && order.size() > 2)
        segments.push_back({order.back(), order.front()});
    return segments;
}

}  // namespace

StrokeShapes shapes_of(const StrokeSource& source, int gltf_mode, uint64_t& broken) {
    const auto& positions = source.vertices.mesh.positions;
    StrokeShapes shapes;
    std::vector<bool> drawn(positions.size(), false);
    const auto draw = [&](uint32_t vertex) {
        if (!drawn[vertex]) shapes.spheres.push_back(vertex);
        drawn[vertex] = true;
    };
    if (gltf_mode == TINYGLTF_MODE_POINTS) {
        for (const uint32_t vertex : source.order)
            is_finite(positions[vertex]) ? draw(vertex) : void(++broken);
        return shapes;
    }
    for (const auto& [a, b] : to_segments(source.order, gltf_mode)) {
        if (!is_finite(positions[a]) || !is_finite(positions[b])) {
            ++broken;
            continue;
        }
        draw(a), draw(b);
        if (positions[a] != positions[b]) shapes.cylinders.push_back({a, b});
    }
    return shapes;
}

void Strokes::add(Group& group, const M44d& to_world, const Mesh& vertices, uint32_t from,
                  uint32_t to) const {
    const bool coloured = !vertices.colours.empty();
    if (coloured && group.colours.empty())
        group.colours.resize(2 * group.instances.size(), V4f(1.f));
    if (coloured)
        group.colours.insert(group.colours.end(), {vertices.colours[from], vertices.colours[to]});
    else if (!group.colours.empty())
        group.colours.insert(group.colours.end(), 2, V4f(1.f));
    group.instances.push_back({.identity = false,
                               .to_world = M44f(to_world),
                               .to_local = M33f(linear_part(to_world.inverse()))});
}

void Strokes::add(uint32_t material, const Mesh& vertices, const StrokeShapes& shapes,
                  const M44d& to_world) {
    auto& [spheres, cylinders] = by_material_[material];
    const double r = double{radius_m_};
    const auto place = [&](uint32_t vertex) { return V3d(vertices.positions[vertex]) * to_world; };
    const auto in_range = [](const V3d& p) { return is_finite(V3f(p)); };
    for (const uint32_t v : shapes.spheres)
        if (in_range(place(v)))
            add(spheres, rows({r, 0, 0}, {0, r, 0}, {0, 0, r}, place(v)), vertices, v, v);
    for (const auto& [a, b] : shapes.cylinders) {
        const V3d from = place(a), along = place(b) - from;
        const double length = along.length();
        if (!in_range(from) || !in_range(from + along)) continue;
        if (!(length > kShortest * r)) continue;  // the spheres cover it
        const Frame frame = Frame::about(V3f(along / length));
        const V3d x = V3d(frame.x), y = V3d(frame.y);
        add(cylinders, rows(x * r, along, y * -r, from), vertices, a, b);
    }
}

void Strokes::finish(Scene& scene, const GltfMaterials& materials) {
    for (auto& [material, groups] : by_material_)
        for (Group& group : groups) {
            if (group.instances.empty()) continue;
            Mesh mesh = &group == &groups[0] ? unit_sphere() : unit_cylinder();
            mesh.material = material;
            mesh.more_uv.resize(materials.more_sets(material).size());
            if (!group.colours.empty()) {
                mesh.colours = std::move(group.colours);
                mesh.colours_from = static_cast<uint32_t>(scene.instances.size());
            }
            for (Instance& instance : group.instances)
                instance.mesh = static_cast<uint32_t>(scene.meshes.size());
            scene.meshes.push_back(std::move(mesh));
            scene.instances.insert(scene.instances.end(), group.instances.begin(),
                                   group.instances.end());
            group = {};
        }
}

}  // namespace petzval::io
