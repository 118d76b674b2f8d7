// SPDX-License-Identifier: Apache-2.0
#include "core/scene/volume_ranks.h"

#include <Imath/ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "core/scene/motion.h"

namespace petzval {
namespace {

using Corners = std::vector<std::array<V3f, 3>>;

// Triangles of a material from which on parts that are open by themselves count as open together.
constexpr size_t kMostLoose = 1 << 22;
constexpr size_t kMostBoxes = 64;

// Part of a surface whose triangles hang together by their corners.
struct Body {
    Box3f box;
    double volume = 0;  // m^3, where the surface is closed; below 0 where it faces inwards
    bool touches_itself = false;  // it is several bodies that share edges
    Box3f reach{};                // box about it at all times while the shutter is open
    bool closed = true;           // it has no border

    // Whether it holds nothing, but for what rounding may leave.
    [[nodiscard]] bool flat() const {
        const double diagonal_m = double(box.size().length());
        return std::fabs(volume) <= 1e-9 * diagonal_m * diagonal_m * diagonal_m;
    }
};

struct Bodies {
    bool closed = false;  // the surface has no border
    std::vector<Body> bodies;
};

// Sets of numbers that count as one.
class Unions {
  public:
    uint32_t add() {
        parent_.push_back(static_cast<uint32_t>(parent_.size()));
        return parent_.back();
    }
    [[nodiscard]] uint32_t root(uint32_t a) {
        while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
        return a;
    }
    void unite(uint32_t a, uint32_t b) { parent_[root(a)] = root(b); }
    [[nodiscard]] size_t size() const { return parent_.size(); }

  private:
    std::vector<uint32_t> parent_;
};

// Numbers of the corners, where those at the same place have one number, and how many numbers there
// may be. Exporters round the two ends of a seam differently: points that lie within 2e-6 of the
// largest coordinate count as one, and may as one up to some ten times that.
std::pair<std::vector<uint32_t>, size_t> weld(const Corners& triangles, const Box3f& box) {
    float largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, std::fabs(box.min[i]), std::fabs(box.max[i])});
    const double cell = std::max(1.6e-5 * double(largest), 1e-30);
    constexpr double margin = 0.125;  // of a cell
    std::unordered_map<uint64_t, uint32_t> cells;
    Unions places;
    std::vector<uint32_t> numbers;
    numbers.reserve(3 * triangles.size());
    for (const auto& triangle : triangles)
        for (const V3f& p : triangle) {
            std::array<uint64_t, 3> at;
            std::array<int, 3> beside;  // the cell that is near along each axis, or 0
            for (int i = 0; i < 3; ++i) {
                const auto k = static_cast<size_t>(i);
                const double x = (double(p[i]) - double(box.min[i])) / cell + 1;
                at[k] = static_cast<uint64_t>(x);
                const double within = x - std::floor(x);
                beside[k] = within < margin ? -1 : within > 1 - margin ? 1 : 0;
            }
            const auto key = [&](unsigned axes) {
                uint64_t bits = 0;
                for (size_t k = 0; k < 3; ++k)
                    bits =
                        bits << 20 | (at[k] + (axes >> k & 1 ? uint64_t(int64_t(beside[k])) : 0));
                return bits;
            };
            const auto [home, is_new] = cells.try_emplace(key(0), 0);
            if (is_new) home->second = places.add();
            numbers.push_back(home->second);
            const unsigned near =
                (beside[0] ? 1u : 0u) | (beside[1] ? 2u : 0u) | (beside[2] ? 4u : 0u);
            for (unsigned axes = near; axes > 0; axes = (axes - 1) & near)
                if (const auto other = cells.find(key(axes)); other != cells.end())
                    places.unite(numbers.back(), other->second);
        }
    for (uint32_t& n : numbers) n = places.root(n);
    return {std::move(numbers), places.size()};
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
    if (box.isEmpty()) return out;
    if (!std::isfinite(box.size().length())) {  // beyond what can be looked at
        out.bodies.push_back({box, 0, false, box, false});
        return out;
    }
    const auto [number, places] = weld(triangles, box);
    Unions joined;
    for (size_t i = 0; i < places; ++i) joined.add();
    std::vector<Edge> edges;
    edges.reserve(number.size());
    for (size_t i = 0; i < number.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = number[i + k], b = number[i + (k + 1) % 3];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
            joined.unite(a, b);
        }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.ends() < b.ends(); });
    std::unordered_map<uint32_t, size_t> body_of;
    for (size_t i = 0; i < triangles.size(); ++i) {
        const auto [at, is_new] =
            body_of.try_emplace(joined.root(number[3 * i]), out.bodies.size());
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
        if (sum == 0 && end - i <= 2) continue;
        Body& body = out.bodies[body_of.at(joined.root(edges[i].low))];
        body.closed &= sum == 0;
        body.touches_itself |= end - i > 2;
    }
    for (Body& body : out.bodies) body.reach = body.box;
    return out;
}

// Lets bodies come wherever a box is.
void extend_reach(Bodies& all, const Box3f& box) {
    for (Body& body : all.bodies) body.reach.extendBy(box);
}

// Box about all shapes of a mesh that deforms; empty for others.
Box3f box_of_steps(const Mesh& mesh) {
    Box3f box;
    for (const MeshStep& step : mesh.steps)
        for (const auto& triangle : mesh.triangles)
            for (const uint32_t corner : triangle) box.extendBy(step.positions[corner]);
    return box;
}

Corners corners_of(const Mesh& mesh) {
    Corners corners;
    corners.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        corners.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    return corners;
}

// Box about all places of a box that an instance moves.
Box3f placed_at_all_times(const Scene& scene, const Box3f& box, uint32_t index) {
    const Instance& instance = scene.instances[index];
    if (instance.identity) return box;
    const auto* const places = places_of(scene, index);
    if (!places) return Imath::transform(box, instance.to_world);
    Box3f all;
    for (const M44f& m : *places) all.extendBy(Imath::transform(box, m));
    return all;
}

Body placed(const Scene& scene, const Body& body, uint32_t index) {
    const Instance& instance = scene.instances[index];
    if (instance.identity) return body;
    const M44f& m = instance.to_world;
    const V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]);
    return {Imath::transform(body.box, m), body.volume * std::fabs(x.dot(y.cross(z))),
            body.touches_itself, placed_at_all_times(scene, body.reach, index)};
}

// Whether its coverage may leave holes.
bool has_holes(const Material& m, const Mesh& mesh) {
    if (!m.cutout()) return false;
    const float least = m.alpha_mode == AlphaMode::Mask ? m.alpha_cutoff : 1.f;
    return m.base_color_texture.present() || !mesh.colours.empty() || m.alpha < least;
}

// Bodies of each material that refracts, in the world. Meshes that are closed by themselves are
// looked at once, however many instances they have; the others of a material may close each other.
std::vector<Bodies> bodies_of_materials(Scene& scene) {
    std::vector<Bodies> of_mesh(scene.meshes.size()), out(scene.materials.size());
    std::vector<Corners> loose(scene.materials.size());
    std::vector<Box3f> reach_of_loose(scene.materials.size());  // of those that move
    std::vector<bool> is_seen(scene.meshes.size(), false);
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        Material& material = scene.materials[mesh.material];
        if (!material.refracts()) continue;
        if (has_holes(material, mesh)) material.volume_fault = VolumeFault::Holes;
        Bodies& bodies = of_mesh[instance.mesh];
        if (!is_seen[instance.mesh]) {
            bodies = find_bodies(corners_of(mesh));
            extend_reach(bodies, box_of_steps(mesh));
        }
        is_seen[instance.mesh] = true;
        if (bodies.closed) {
            for (const Body& b : bodies.bodies)
                out[mesh.material].bodies.push_back(placed(scene, b, i));
            continue;
        }
        if (instance.moves)
            for (const Body& b : bodies.bodies)
                reach_of_loose[mesh.material].extendBy(placed_at_all_times(scene, b.reach, i));
        for (uint32_t triangle = 0;
             triangle < mesh.triangles.size() && loose[mesh.material].size() <= kMostLoose;
             ++triangle) {
            auto corners = triangle_corners(scene, i, triangle);
            if (instance.flips) std::swap(corners[1], corners[2]);
            loose[mesh.material].push_back(corners);
        }
    }
    for (size_t m = 0; m < out.size(); ++m) {
        out[m].closed = !out[m].bodies.empty();
        if (loose[m].empty()) continue;
        Bodies rest =
            loose[m].size() > kMostLoose ? Bodies{false, {Body{}}} : find_bodies(loose[m]);
        extend_reach(rest, reach_of_loose[m]);
        out[m].closed = rest.closed;
        out[m].bodies.insert(out[m].bodies.end(), rest.bodies.begin(), rest.bodies.end());
    }
    return out;
}

// Marks thin glass in the shape of a body: a thickness may have been forgotten.
void mark_thin_bodies(Scene& scene) {
    std::vector<bool> is_seen(scene.meshes.size(), false);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        Material& material = scene.materials[mesh.material];
        if (!material.thin_glass() || material.meant_thin || material.thin_body) continue;
        if (is_seen[instance.mesh] || has_holes(material, mesh)) continue;
        is_seen[instance.mesh] = true;
        const Bodies found = find_bodies(corners_of(mesh));
        material.thin_body = std::any_of(found.bodies.begin(), found.bodies.end(),
                                         [](const Body& b) { return b.closed && !b.flat(); });
    }
}

bool contains(const Box3f& outer, const Box3f& inner) {
    return outer.intersects(inner.min) && outer.intersects(inner.max);
}

// A body that faces inwards is a cavity of one that faces outwards and holds it.
VolumeFault fault_of(Bodies& of_material) {
    if (!of_material.closed) return VolumeFault::Open;
    auto& bodies = of_material.bodies;
    std::sort(bodies.begin(), bodies.end(),
              [](const Body& a, const Body& b) { return a.volume > b.volume; });
    for (const Body& b : bodies) {
        if (b.flat()) return VolumeFault::Flat;
        const auto holds = [&](const Body& o) { return o.volume > 0 && contains(o.box, b.box); };
        if (b.volume < 0 && std::none_of(bodies.begin(), bodies.end(), holds))
            return VolumeFault::InsideOut;
    }
    return VolumeFault::None;
}

struct PlacedBody {
    Box3f box;
    uint32_t material;
    bool touches_itself;
};

// Marks what may overlap: bodies whose boxes meet. A box grows by a millionth of where it is, as
// faces that only touch are rounded.
void mark_overlaps(Scene& scene, std::vector<PlacedBody> bodies) {
    Box3f all;
    for (PlacedBody& b : bodies) {
        all.extendBy(b.box);
        const V3f far = (abs(b.box.min) + abs(b.box.max)) * 1e-6f;
        b.box.min -= far;
        b.box.max += far;
    }
    const auto axis = static_cast<int>(all.majorAxis());
    std::sort(bodies.begin(), bodies.end(), [&](const PlacedBody& a, const PlacedBody& b) {
        return a.box.min[axis] < b.box.min[axis];
    });
    for (size_t i = 0; i < bodies.size(); ++i) {
        const PlacedBody& a = bodies[i];
        if (a.touches_itself) scene.materials[a.material].overlaps_itself = true;
        scene.volumes_meet |= a.touches_itself;
        for (size_t j = i + 1; j < bodies.size() && bodies[j].box.min[axis] <= a.box.max[axis];
             ++j) {
            if (!a.box.intersects(bodies[j].box)) continue;
            scene.volumes_meet = true;
            if (a.material == bodies[j].material)
                scene.materials[a.material].overlaps_itself = true;
        }
    }
}

}  // namespace

void rank_volumes(Scene& scene) {
    scene.volume_boxes.clear();
    scene.volumes_meet = false;
    for (Material& m : scene.materials) {
        m.priority = 0;
        m.overlaps_itself = false;
        m.volume_fault = VolumeFault::None;
        m.thin_body = false;
    }
    mark_thin_bodies(scene);
    if (std::none_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.refracts(); }))
        return;
    std::vector<Bodies> of_material = bodies_of_materials(scene);
    struct Ranked {
        uint32_t material;
        double largest_m3;
        Box3f box;
    };
    std::vector<Ranked> ranked;
    std::vector<PlacedBody> bodies;
    for (uint32_t m = 0; m < of_material.size(); ++m) {
        Material& material = scene.materials[m];
        if (of_material[m].bodies.empty()) continue;
        if (material.volume_fault == VolumeFault::None)
            material.volume_fault = fault_of(of_material[m]);
        if (material.volume_fault != VolumeFault::None) continue;
        Ranked r{m, 0, {}};
        for (const Body& b : of_material[m].bodies) {
            r.largest_m3 = std::max(r.largest_m3, b.volume);
            r.box.extendBy(b.box);
            bodies.push_back({b.reach, m, b.touches_itself});
            if (b.volume > 0) scene.volume_boxes.push_back(b.reach);
        }
        ranked.push_back(r);
    }
    if (scene.volume_boxes.size() > kMostBoxes) {
        Box3f all;
        for (const Box3f& box : scene.volume_boxes) all.extendBy(box);
        scene.volume_boxes = {all};
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

}  // namespace petzval
