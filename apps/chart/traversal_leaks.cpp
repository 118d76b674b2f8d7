// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/traversal_leaks.h"

#include <algorithm>
#include <tuple>

#include "core/sampling/warp.h"

namespace petzval::apps {
namespace {

constexpr size_t kMostTriangles = 1u << 18;  // of a mesh
constexpr int kTries = 16;                   // of a direction, for each ray

/// Edge that two triangles share: its ends, and the corner on either side.
struct SharedEdge {
    V3f a, b;
    std::array<V3f, 2> corner;
};

struct HalfEdge {
    std::array<V3f, 2> ends;  ///< in the order of operator<
    V3f corner;
};

bool before(const V3f& a, const V3f& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// Adds the edges that two triangles share, by position, not by index: meshes with flat normals
// repeat their vertices.
void add_shared_edges(const Scene& scene, uint32_t instance, std::vector<SharedEdge>& shared) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    if (scene.materials[mesh.material].cutout()) return;
    std::vector<HalfEdge> edges;
    const auto triangles =
        static_cast<uint32_t>(std::min<size_t>(mesh.triangles.size(), kMostTriangles));
    edges.reserve(3 * size_t{triangles});
    for (uint32_t t = 0; t < triangles; ++t) {
        const auto corner = triangle_corners(scene, instance, t);
        for (size_t k = 0; k < 3; ++k) {
            HalfEdge edge{{corner[k], corner[(k + 1) % 3]}, corner[(k + 2) % 3]};
            if (before(edge.ends[1], edge.ends[0])) std::swap(edge.ends[0], edge.ends[1]);
            edges.push_back(edge);
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& p, const HalfEdge& q) {
        if (p.ends[0] != q.ends[0]) return before(p.ends[0], q.ends[0]);
        if (p.ends[1] != q.ends[1]) return before(p.ends[1], q.ends[1]);
        return before(p.corner, q.corner);
    });
    for (size_t i = 0; i + 1 < edges.size(); ++i)
        if (edges[i].ends == edges[i + 1].ends && edges[i].ends[0] != edges[i].ends[1])
            shared.push_back(
                {edges[i].ends[0], edges[i].ends[1], {edges[i].corner, edges[i + 1].corner}});
}

/// Whether a ray of that direction meets the two triangles on different sides of their edge, and
/// neither of them at a graze: then only rounding can lead it between them.
bool crosses(const SharedEdge& one, const V3f& direction) {
    constexpr float kLeastCosine = 0.2f;
    const V3f edge = one.b - one.a, side = edge.cross(direction);
    const float scale = kLeastCosine * edge.length();
    std::array<float, 2> off{};
    for (size_t k = 0; k < 2; ++k) {
        const V3f to_corner = one.corner[k] - one.a, normal = edge.cross(to_corner);
        const float normal_length = normal.length();
        // A sliver may be thinner than its vertices are exact.
        if (!(normal_length > 1e-3f * edge.dot(edge))) return false;
        if (std::fabs(normal.dot(direction)) < kLeastCosine * normal_length) return false;
        off[k] = side.dot(to_corner);
    }
    return off[0] * off[1] < 0 && side.length() > scale;
}

}  // namespace

std::vector<Ray> shared_edge_rays(const Scene& scene, size_t count, uint32_t seed) {
    std::vector<SharedEdge> shared;
    std::vector<bool> seen(scene.meshes.size());
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        if (seen[scene.instances[i].mesh]) continue;
        seen[scene.instances[i].mesh] = true;
        add_shared_edges(scene, i, shared);
    }
    std::vector<Ray> rays;
    if (shared.empty()) return rays;
    uint32_t draws = 0;
    const auto random = [&] { return to_unit_float(hash32(seed, draws++)); };
    for (size_t i = 0; i < count; ++i) {
        const auto at = static_cast<size_t>(random() * static_cast<float>(shared.size()));
        const SharedEdge& one = shared[std::min(at, shared.size() - 1)];
        const V3f aim = one.a + (one.b - one.a) * random();
        for (int k = 0; k < kTries; ++k) {
            const float turn = random(), height = random();
            const V3f direction = uniform_sphere(V2f(turn, height));
            if (!crosses(one, direction)) continue;
            const float away = (one.b - one.a).length();
            Ray ray;
            ray.origin = aim - direction * away;
            ray.direction = unit(aim - ray.origin);
            ray.t_max = away * 1.01f;
            rays.push_back(ray);
            break;
        }
    }
    return rays;
}

size_t traversal_leaks(const Bvh& bvh, const std::vector<Ray>& shared_edge_rays) {
    return static_cast<size_t>(std::count_if(shared_edge_rays.begin(), shared_edge_rays.end(),
                                             [&](const Ray& r) { return !bvh.intersect(r); }));
}

}  // namespace petzval::apps
