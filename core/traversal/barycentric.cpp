// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/barycentric.h"

#include <algorithm>

#include "core/scene/motion.h"

namespace petzval {
namespace {

// Corner relative to the origin of a ray.
V3d from_origin(const Instance& instance, const V3f& corner, const V3d& origin) {
    const V3d p(corner);
    if (instance.identity) return p - origin;
    const M44f& m = instance.to_world;
    V3d placed;
    for (int j = 0; j < 3; ++j)
        placed[j] =
            p.x * double{m[0][j]} + p.y * double{m[1][j]} + p.z * double{m[2][j]} + double{m[3][j]};
    return placed - origin;
}

// Corners of a triangle of an instance relative to the origin of a ray.
template <bool kStill>
std::array<V3d, 3> corners_from(const Scene& scene, const Instance& placement, uint32_t triangle,
                                const Ray& ray) {
    const Mesh& mesh = scene.meshes[placement.mesh];
    CornerValues moved;
    const auto corner = corner_positions<kStill>(mesh, mesh.triangles[triangle], ray.time, moved);
    const V3d origin(ray.origin);
    return {from_origin(placement, *corner[0], origin), from_origin(placement, *corner[1], origin),
            from_origin(placement, *corner[2], origin)};
}

std::array<V3d, 3> corners_from(const Scene& scene, uint32_t instance, uint32_t triangle,
                                const Ray& ray) {
    if (const Instance& still = scene.instances[instance]; !still.moves) [[likely]]
        return corners_from<true>(scene, still, triangle, ray);
    return with_instance_at(scene, instance, ray.time, [&](const Instance& placement) {
        return corners_from<false>(scene, placement, triangle, ray);
    });
}

}  // namespace

// Weights in the ratio of the signed volumes that the ray spans with the edges: Kensler and Shirley
// 2006, "Optimizing Ray-Triangle Intersection via Automated Search".
V2f barycentric(const Scene& scene, uint32_t instance, uint32_t triangle, const Ray& ray) {
    const auto [a, b, c] = corners_from(scene, instance, triangle, ray);
    const V3d direction(ray.direction);
    // Edge times sum in place of corner times corner: twice the volume, and far from a small
    // triangle without its cancellation.
    const double of_a = direction.dot((c - b).cross(c + b));
    const double of_b = direction.dot((a - c).cross(a + c));
    const double of_c = direction.dot((b - a).cross(b + a));
    const double whole = of_a + of_b + of_c;
    if (whole == 0.) return V2f(1.f / 3.f);  // in the triangle's plane: any point of it is met
    // The traversal rounds otherwise at the edges.
    const double u = std::max(of_b / whole, 0.), v = std::max(of_c / whole, 0.);
    const double beyond = std::max(u + v, 1.);
    return {static_cast<float>(u / beyond), static_cast<float>(v / beyond)};
}

}  // namespace petzval
