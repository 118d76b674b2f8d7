// SPDX-License-Identifier: Apache-2.0
// Triangles by their corners, with all that a corner has: as the loader has them, and as a file
// says by the reference of tests/support/animation/truth.h. Vertices may have any order and be
// split.
#pragma once

#include <gtest/gtest.h>

#include "core/scene/motion.h"
#include "tests/support/animation/truth.h"
#include "tests/support/moving_gltf.h"

namespace petzval::test {

/// What a corner has; parts that are not there are empty.
struct Corner {
    std::vector<double> position, normal, tangent;
    std::vector<double> rest;  ///< texture coordinates and colour
    bool any_tangent = false;  ///< the reference does not know the tangent
};
/// Counter-clockwise seen from the front.
using Corners = std::array<Corner, 3>;

/// Matrices by which a corner of the reference moves: its vertex's, beside the triangle.
struct TrueTriangle {
    Corners corners;
    std::array<Columns, 3> to_world;
    bool mirrored = false;
};

template <class Vector>
void append(std::vector<double>& to, const Vector& values, size_t count) {
    for (size_t k = 0; k < count; ++k) to.push_back(double(values[int(k)]));
}

/// The corners of a scene at a time while the shutter is open; directions are in the world.
[[nodiscard]] inline std::vector<Corners> corners_of(const Scene& scene, float time = 0.5f) {
    std::vector<Corners> out;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const int map_set = scene.materials[mesh.material].normal_texture.uv_set;
        const Instance placed =
            with_instance_at(scene, i, time, [](const Instance& at) { return at; });
        Columns move{};
        for (size_t k = 0; k < 16; ++k) move[k] = double(placed.to_world.getValue()[k]);
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto at = triangle_corners(scene, i, t, time);
            CornerValues moved_normal_values;
            const auto normals = mesh.normals.empty() ? CornerPointers{}
                                                      : corner_normals(mesh, mesh.triangles[t],
                                                                       time, moved_normal_values);
            Corners& corners = out.emplace_back();
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.triangles[t][k];
                append(corners[k].position, at[k], 3);
                if (!mesh.normals.empty()) {
                    const V3f& n = *normals[k];
                    const Three world = moved_normal(move, {n.x, n.y, n.z});
                    corners[k].normal.assign(world.begin(), world.end());
                }
                if (!mesh.tangents.empty()) {
                    const V2f b(k == 1 ? 1.f : 0.f, k == 2 ? 1.f : 0.f);
                    const V4f tangent = tangent_at(mesh, t, b, time);
                    const Three world = moved(move, {tangent.x, tangent.y, tangent.z}, 0);
                    const double length = std::hypot(world[0], world[1], world[2]);
                    for (const double x : world) corners[k].tangent.push_back(x / length);
                    corners[k].tangent.push_back(placed.flips ? -tangent.w : tangent.w);
                }
                for (const auto& uv : mesh.uv)
                    if (!uv.empty()) append(corners[k].rest, uv[v], 2);
                if (map_set > 1) append(corners[k].rest, mesh.uv_of(map_set)[v], 2);
                if (!mesh.colours.empty()) append(corners[k].rest, mesh.colours[v], 4);
            }
            if (placed.flips) std::swap(corners[1], corners[2]);
        }
    }
    return out;
}

/// The corners of all nodes with a mesh, by the reference.
class CornerTruth : public AnimationTruth {
  public:
    using AnimationTruth::AnimationTruth;

    [[nodiscard]] std::vector<TrueTriangle> triangles() const {
        std::vector<TrueTriangle> out;
        for (size_t n = 0; n < root()["nodes"].size(); ++n) {
            const auto& node = root()["nodes"][n];
            if (!node.contains("mesh")) continue;
            const auto& mesh = root()["meshes"][node["mesh"].get<size_t>()];
            const auto weights =
                node.value("weights", mesh.value("weights", std::vector<double>()));
            for (const auto& primitive : mesh["primitives"]) add(n, weights, primitive, out);
        }
        return out;
    }

  private:
    using Rows = std::vector<std::vector<double>>;

    // An attribute of each vertex, morphed.
    [[nodiscard]] Rows rows(const nlohmann::json& primitive, const std::string& name,
                            const std::vector<double>& weights) const {
        const auto& attributes = primitive["attributes"];
        if (!attributes.contains(name)) return {};
        const auto& accessor = root()["accessors"][attributes[name].get<size_t>()];
        const std::vector<double> all = numbers(attributes[name]);
        const size_t count = accessor["count"], width = all.size() / count;
        Rows out(count);
        for (size_t i = 0; i < all.size(); ++i) out[i / width].push_back(all[i]);
        bool morphs = false;
        for (size_t t = 0; t < weights.size(); ++t) {
            const auto& target = primitive["targets"][t];
            if (!target.contains(name)) continue;
            const std::vector<double> by = numbers(target[name]);
            const size_t own = by.size() / count;
            for (size_t i = 0; i < by.size(); ++i) out[i / own][i % own] += weights[t] * by[i];
            morphs |= weights[t] != 0;
        }
        if (name != "COLOR_0") return out;
        for (auto& row : out) {
            if (row.size() == 3) row.push_back(1);
            if (morphs)
                for (double& x : row) x = std::min(std::max(x, 0.), 1.);
        }
        return out;
    }

    void add(size_t number, const std::vector<double>& weights, const nlohmann::json& primitive,
             std::vector<TrueTriangle>& to) const {
        const auto& node = root()["nodes"][number];
        const auto read = [&](const std::string& name) { return rows(primitive, name, weights); };
        const Rows positions = read("POSITION"), normals = read("NORMAL"),
                   colours = read("COLOR_0");
        std::vector<Rows> uv = {read("TEXCOORD_0"), read("TEXCOORD_1")};
        Rows tangents;
        if (const int set = mapped_set(primitive); set >= 0) {
            if (set > 1) uv.push_back(read("TEXCOORD_" + std::to_string(set)));
            if (!normals.empty()) tangents = read("TANGENT");
        }
        const bool skinned = node.contains("skin") && primitive["attributes"].contains("JOINTS_0");
        const std::vector<Columns> each =
            skinned ? skin_matrices(root()["skins"][node["skin"].get<size_t>()],
                                    primitive["attributes"], positions.size())
                    : std::vector<Columns>(positions.size(), world(number));
        const size_t first = to.size();
        for (const auto& triangle : order(primitive, positions.size())) {
            TrueTriangle& out = to.emplace_back();
            out.mirrored = true;
            for (size_t k = 0; k < 3; ++k) {
                const size_t v = triangle[k];
                out.to_world[k] = each[v];
                out.mirrored &= mirrors(each[v]);
                Corner& corner = out.corners[k];
                const Three p =
                    moved(each[v], {positions[v][0], positions[v][1], positions[v][2]}, 1);
                corner.position.assign(p.begin(), p.end());
                if (!normals.empty()) {
                    const Three n =
                        moved_normal(each[v], {normals[v][0], normals[v][1], normals[v][2]});
                    corner.normal.assign(n.begin(), n.end());
                }
                if (!tangents.empty()) corner.tangent = moved_tangent(each[v], tangents[v]);
                for (const Rows& set : uv)
                    if (!set.empty())
                        corner.rest.insert(corner.rest.end(), set[v].begin(), set[v].end());
                if (!colours.empty())
                    corner.rest.insert(corner.rest.end(), colours[v].begin(), colours[v].end());
            }
        }
        // What is mirrored as a whole shows its fronts still.
        const auto begin = to.begin() + std::ptrdiff_t(first);
        const bool all = std::all_of(begin, to.end(), [](const auto& t) { return t.mirrored; });
        for (auto at = begin; at != to.end(); ++at) {
            at->mirrored = all;
            if (!all) continue;
            std::swap(at->corners[1], at->corners[2]);
            std::swap(at->to_world[1], at->to_world[2]);
        }
    }

    [[nodiscard]] int mapped_set(const nlohmann::json& primitive) const {
        if (!primitive.contains("material")) return -1;
        const auto& material = root()["materials"][primitive["material"].get<size_t>()];
        return material.contains("normalTexture") ? material["normalTexture"].value("texCoord", 0)
                                                  : -1;
    }

    [[nodiscard]] std::vector<std::array<size_t, 3>> order(const nlohmann::json& primitive,
                                                           size_t vertices) const {
        std::vector<size_t> index;
        if (primitive.contains("indices"))
            for (const double i : numbers(primitive["indices"])) index.push_back(size_t(i));
        else
            for (size_t i = 0; i < vertices; ++i) index.push_back(i);
        std::vector<std::array<size_t, 3>> out;
        const int mode = primitive.value("mode", 4);
        for (size_t i = 0; i + 2 < index.size(); i += mode == 4 ? 3 : 1) {
            const size_t first = mode == 6 ? index[0] : index[i];
            if (mode == 5 && i % 2 == 1)
                out.push_back({index[i + 1], index[i], index[i + 2]});
            else
                out.push_back({first, index[i + 1], index[i + 2]});
        }
        return out;
    }

  public:
    [[nodiscard]] static bool mirrors(const Columns& m) {
        return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
                   m[8] * (m[1] * m[6] - m[2] * m[5]) <
               0;
    }
    [[nodiscard]] static std::vector<double> moved_tangent(const Columns& m,
                                                           const std::vector<double>& t) {
        const Three d = moved(m, {t[0], t[1], t[2]}, 0);
        const double length = std::hypot(d[0], d[1], d[2]);
        const double sign = (t[3] < 0) == mirrors(m) ? 1 : -1;
        return {d[0] / length, d[1] / length, d[2] / length, sign};
    }
};

/// Greatest difference of two rows of numbers; infinite where one is there and the other is not.
[[nodiscard]] inline double apart(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) return HUGE_VAL;
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double off = std::fabs(a[i] - b[i]);
        most = off <= most ? most : off;  // NaN stays
    }
    return most;
}

enum class Compared { All, WithoutTangents };

[[nodiscard]] inline double apart(const Corners& a, const Corners& b, size_t turned,
                                  Compared compared) {
    double most = 0;
    for (size_t k = 0; k < 3; ++k) {
        const Corner &x = a[k], &y = b[(k + turned) % 3];
        most = std::max({most, apart(x.position, y.position), apart(x.normal, y.normal),
                         apart(x.rest, y.rest)});
        if (compared == Compared::All && !x.any_tangent)
            most = std::max(most, apart(x.tangent, y.tangent));
    }
    return most;
}

/// Twice the area.
[[nodiscard]] inline double area_of(const Corners& c) {
    const auto edge = [&](size_t k) {
        return V3d(c[k].position[0] - c[0].position[0], c[k].position[1] - c[0].position[1],
                   c[k].position[2] - c[0].position[2]);
    };
    return edge(1).cross(edge(2)).length();
}

/// Finds for each wanted triangle one of the same corners: calls found(wanted, other, turned),
/// where corner k is corner (k + turned) % 3 of the other. Every triangle of either list must have
/// one, but for those without area, which may have been left out.
template <class Found>
void match(const std::vector<Corners>& wanted, const std::vector<Corners>& others,
           Compared compared, Found found) {
    constexpr double kTolerance = 2e-5, kArea = 1e-4;
    std::vector<bool> taken(others.size(), false);
    for (size_t i = 0; i < wanted.size(); ++i) {
        double least = HUGE_VAL;
        size_t best = 0, best_turned = 0;
        for (size_t j = 0; j < others.size(); ++j)
            for (size_t turned = 0; turned < 3 && !taken[j]; ++turned)
                if (const double off = apart(wanted[i], others[j], turned, compared); off < least) {
                    least = off;
                    best = j;
                    best_turned = turned;
                }
        if (least <= kTolerance) {
            taken[best] = true;
            found(i, best, best_turned);
        } else if (area_of(wanted[i]) > kArea) {
            ADD_FAILURE() << "triangle " << i << " of " << wanted.size() << " is off by " << least
                          << " at least, among " << others.size();
            return;
        }
    }
    for (size_t j = 0; j < others.size(); ++j)
        if (!taken[j] && area_of(others[j]) > kArea) {
            ADD_FAILURE() << "triangle " << j << " should not be there";
            return;
        }
}

inline void expect_same_corners(const std::vector<Corners>& wanted,
                                const std::vector<Corners>& found,
                                Compared compared = Compared::All) {
    match(wanted, found, compared, [](size_t, size_t, size_t) {});
}

}  // namespace petzval::test
