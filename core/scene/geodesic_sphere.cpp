// SPDX-License-Identifier: Apache-2.0
#include "core/scene/geodesic_sphere.h"

#include <array>
#include <map>
#include <numbers>

namespace petzval {
namespace {

// A unit icosahedron: corners at the even permutations of (0, 1, golden ratio).
Mesh icosahedron() {
    const auto a = static_cast<float>(1 / std::sqrt(2 + std::numbers::phi));
    const auto b = static_cast<float>(std::numbers::phi) * a;
    Mesh mesh;
    for (const float u : {-a, a})
        for (const float v : {-b, b}) {
            mesh.positions.emplace_back(0.f, u, v);
            mesh.positions.emplace_back(u, v, 0.f);
            mesh.positions.emplace_back(v, 0.f, u);
        }
    // Faces are the triples of corners at the distance of an edge, 2a.
    const auto joined = [&](uint32_t i, uint32_t j) {
        return (mesh.positions[i] - mesh.positions[j]).length() < 2.1f * a;
    };
    const auto count = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t j = i + 1; j < count; ++j)
            for (uint32_t k = j + 1; k < count; ++k) {
                if (!joined(i, j) || !joined(j, k) || !joined(k, i)) continue;
                const V3f &p = mesh.positions[i], &q = mesh.positions[j], &r = mesh.positions[k];
                const bool outwards = (q - p).cross(r - p).dot(p) > 0;
                mesh.triangles.push_back({i, outwards ? j : k, outwards ? k : j});
            }
    return mesh;
}

// Every triangle as four, their new corners on the unit sphere.
Mesh halved(const Mesh& from) {
    Mesh mesh;
    mesh.positions = from.positions;
    std::map<std::array<uint32_t, 2>, uint32_t> middles;
    const auto middle = [&](uint32_t i, uint32_t j) {
        const auto [at, is_new] = middles.try_emplace({std::min(i, j), std::max(i, j)},
                                                      static_cast<uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(unit(from.positions[i] + from.positions[j]));
        return at->second;
    };
    for (const auto& [a, b, c] : from.triangles) {
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        mesh.triangles.insert(mesh.triangles.end(),
                              {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    return mesh;
}

}  // namespace

Mesh geodesic_sphere(int halvings) {
    Mesh mesh = icosahedron();
    for (int i = 0; i < halvings; ++i) mesh = halved(mesh);
    return mesh;
}

}  // namespace petzval
