// SPDX-License-Identifier: Apache-2.0
#include "core/scene/volume_ranks.h"

#include <Imath/ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace petzval {
namespace {

using Corners = std::vector<std::array<V3f, 3>>;

// Part of a surface whose triangles hang together by their corners.
struct Body {
    Box3f box;
    double volume = 0;  // m^3, where the surface is closed; below 0 where it faces inwards
    bool touches_itself = false;  // it is several bodies that share edges
};

struct Bodies {
    bool closed = false;  // the surface has no border
    std::vector<Body> bodies;
};

// Numbers of the corners, where those at the same place have one number. Exporters round the two
// ends of a seam differently: a place is a cell of 2^-16 of the surface's diagonal.
std::vector<uint32_t> weld(const Corners& triangles, const Box3f& box) {
    const double cell = std::max(double((box.max - box.min).length()) / 65536, 1e-30);
    std::unordered_map<uint64_t, uint32_t> places;
    std::vector<uint32_t> numbers;
    numbers.reserve(3 * triangles.size());
    for (const auto& triangle : triangles)
        for (const V3f& p : triangle) {
            uint64_t key = 0;
            for (int i = 0; i < 3; ++i) {
                const double at = std::round((double(p[i]) - double(box.min[i])) / cell);
                key = key << 18 | static_cast<uint64_t>(at);
            }
            numbers.push_back(places.try_emplace(key, places.size()).first->second);
        }
    return numbers;
}

uint32_t root_of(std::vector<uint32_t>& parent, uint32_t a) {
    while (parent[a] != a) a = parent[a] = parent[parent[a]];
    return a;
}

double signed_volume(const std::array<V3f, 3>& t, const V3f& about) {
    const V3d a(t[0] - about), b(t[1] - about), c(t[2] - about);
    return a.dot(b.cross(c)) / 6;
}

struct Edge {
    uint32_t low, high;  // numbers of its ends
    int way;             // 1 from low to high, -1 back

    [[nodiscard]] auto ends() const { return std::pair(low, high); }
};

// A surface has no border where each of its edges is run through as often one way as the other.
// Where it is run through more than once each way, bodies touch.
Bodies find_bodies(const Corners& triangles) {
    Box3f box;
    for (const auto& triangle : triangles)
        for (const V3f& p : triangle) box.extendBy(p);
    Bodies out;
    if (box.isEmpty() || !std::isfinite((box.max - box.min).length())) return out;
    const std::vector<uint32_t> number = weld(triangles, box);
    std::vector<uint32_t> parent(number.size());
    std::iota(parent.begin(), parent.end(), 0u);
    std::vector<Edge> edges;
    edges.reserve(number.size());
    for (size_t i = 0; i < number.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = number[i + k], b = number[i + (k + 1) % 3];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
            parent[root_of(parent, a)] = root_of(parent, b);
        }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.ends() < b.ends(); });
    std::unordered_map<uint32_t, size_t> body_of;
    for (size_t i = 0; i < triangles.size(); ++i) {
        const auto [at, is_new] =
            body_of.try_emplace(root_of(parent, number[3 * i]), out.bodies.size());
        if (is_new) out.bodies.emplace_back();
        Body& body = out.bodies[at->second];
        for (const V3f& p : triangles[i]) body.box.extendBy(p);
        body.volume += signed_volume(triangles[i], box.min);
    }
    out.closed = true;
    for (size_t i = 0, end = 0; i < edges.size(); i = end) {
        int sum = 0;
        for (; end < edges.size() && edges[end].ends() == edges[i].ends(); ++end)
            sum += edges[end].way;
        out.closed &= sum == 0;
        if (end - i > 2)
            out.bodies[body_of.at(root_of(parent, edges[i].low))].touches_itself = true;
    }
    return out;
}

Corners corners_of(const Mesh& mesh) {
    Corners corners;
    corners.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        corners.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    return corners;
}

Body placed(const Body& body, const Instance& instance) {
    if (instance.identity) return body;
    const M44f& m = instance.to_world;
    const V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]);
    return {Imath::transform(body.box, m), body.volume * std::fabs(x.dot(y.cross(z))),
            body.touches_itself};
}

bool is_candidate(const Material& m) {
    return m.refracts() && !m.cutout();
}

// Bodies of each material in the world. Meshes that are closed by themselves are looked at once,
// however many instances they have; the others of a material may close each other.
std::vector<Bodies> bodies_of_materials(const Scene& scene) {
    std::vector<Bodies> of_mesh(scene.meshes.size()), out(scene.materials.size());
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        if (is_candidate(scene.materials[scene.meshes[i].material]))
            of_mesh[i] = find_bodies(corners_of(scene.meshes[i]));
    std::vector<Corners> left(scene.materials.size());
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (!is_candidate(scene.materials[mesh.material])) continue;
        const Bodies& bodies = of_mesh[instance.mesh];
        if (bodies.closed) {
            out[mesh.material].closed = true;
            for (const Body& b : bodies.bodies)
                out[mesh.material].bodies.push_back(placed(b, instance));
            continue;
        }
        for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
            auto corners = triangle_corners(scene, i, triangle);
            if (instance.flips) std::swap(corners[1], corners[2]);
            left[mesh.material].push_back(corners);
        }
    }
    for (size_t m = 0; m < out.size(); ++m) {
        if (left[m].empty()) continue;
        const Bodies rest = find_bodies(left[m]);
        out[m].closed = rest.closed;
        out[m].bodies.insert(out[m].bodies.end(), rest.bodies.begin(), rest.bodies.end());
    }
    return out;
}

bool contains(const Box3f& outer, const Box3f& inner) {
    return outer.intersects(inner.min) && outer.intersects(inner.max);
}

// Nothing where the bodies are closed volumes. A body that faces inwards is a cavity of one that
// faces outwards and holds it.
std::optional<VolumeFault> fault_of(const Bodies& of_material) {
    if (!of_material.closed) return VolumeFault::Open;
    constexpr double flat = 1e-9;  // of the cube of the diagonal: what rounding may leave
    for (const Body& b : of_material.bodies) {
        const double diagonal_m = double((b.box.max - b.box.min).length());
        if (std::fabs(b.volume) <= flat * diagonal_m * diagonal_m * diagonal_m)
            return VolumeFault::Flat;
        const auto holds = [&](const Body& o) { return o.volume > 0 && contains(o.box, b.box); };
        if (b.volume < 0 &&
            std::none_of(of_material.bodies.begin(), of_material.bodies.end(), holds))
            return VolumeFault::InsideOut;
    }
    return std::nullopt;
}

struct PlacedBody {
    Box3f box;
    uint32_t material;
    bool touches_itself;
};

// Marks what may overlap: bodies whose boxes meet. A box grows by a millionth of where it is, as
// faces that only touch are rounded.
void mark_overlaps(Scene& scene, std::vector<PlacedBody> bodies) {
    for (PlacedBody& b : bodies) {
        const V3f far = (abs(b.box.min) + abs(b.box.max)) * 1e-6f;
        b.box.min -= far;
        b.box.max += far;
    }
    std::sort(bodies.begin(), bodies.end(),
              [](const PlacedBody& a, const PlacedBody& b) { return a.box.min.x < b.box.min.x; });
    const auto mark = [&](const PlacedBody& a, const PlacedBody& b) {
        scene.nested_bounds.extendBy(a.box);
        scene.nested_bounds.extendBy(b.box);
        if (a.material == b.material) scene.materials[a.material].overlaps_itself = true;
    };
    for (size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].touches_itself) mark(bodies[i], bodies[i]);
        for (size_t j = i + 1; j < bodies.size() && bodies[j].box.min.x <= bodies[i].box.max.x; ++j)
            if (bodies[i].box.intersects(bodies[j].box)) mark(bodies[i], bodies[j]);
    }
}

}  // namespace

void rank_volumes(Scene& scene) {
    if (std::none_of(scene.materials.begin(), scene.materials.end(), is_candidate)) return;
    const std::vector<Bodies> of_material = bodies_of_materials(scene);
    struct Ranked {
        uint32_t material;
        double largest_m3;
        Box3f box;
    };
    std::vector<Ranked> ranked;
    std::vector<PlacedBody> bodies;
    for (uint32_t m = 0; m < of_material.size(); ++m) {
        if (of_material[m].bodies.empty() || fault_of(of_material[m])) continue;
        Ranked r{m, 0, {}};
        for (const Body& b : of_material[m].bodies) {
            r.largest_m3 = std::max(r.largest_m3, b.volume);
            r.box.extendBy(b.box);
            bodies.push_back({b.box, m, b.touches_itself});
        }
        ranked.push_back(r);
    }
    std::sort(ranked.begin(), ranked.end(), [&](const Ranked& a, const Ranked& b) {
        if (a.largest_m3 != b.largest_m3) return a.largest_m3 > b.largest_m3;
        for (int i = 0; i < 3; ++i)
            if (a.box.min[i] != b.box.min[i]) return a.box.min[i] < b.box.min[i];
        return scene.materials[a.material].name < scene.materials[b.material].name;
    });
    for (uint32_t i = 0; i < ranked.size(); ++i)
        scene.materials[ranked[i].material].priority = i + 1;
    mark_overlaps(scene, std::move(bodies));
}

std::vector<FaultyVolume> faulty_volumes(const Scene& scene) {
    const auto unranked = [](const Material& m) { return is_candidate(m) && m.priority == 0; };
    if (std::none_of(scene.materials.begin(), scene.materials.end(), unranked)) return {};
    const std::vector<Bodies> of_material = bodies_of_materials(scene);
    std::vector<FaultyVolume> out;
    for (uint32_t m = 0; m < of_material.size(); ++m) {
        if (of_material[m].bodies.empty()) continue;
        if (const auto fault = fault_of(of_material[m])) out.push_back({m, *fault});
    }
    return out;
}

}  // namespace petzval
