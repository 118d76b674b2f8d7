// SPDX-License-Identifier: Apache-2.0
// Where the vertices of an animated glTF file are, by ways of its own: the reference for what the
// loader shows at a time. Quaternions turn by their logarithm, splines are cut as Bezier curves,
// matrices move columns, and normals go by an inverse that is divided out.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace petzval::test {

using Three = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  ///< x, y, z, w
using Columns = std::array<double, 16>;    ///< matrix, column after column

[[nodiscard]] inline Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
            a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
            a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
            a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

[[nodiscard]] inline Quaternion unit(Quaternion q) {
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    for (double& x : q) x /= length;
    return q;
}

/// a exp(u log(a^-1 b)), where the turn from a to b is at most half a circle.
[[nodiscard]] inline Quaternion turned(const Quaternion& from, const Quaternion& to, double u) {
    const Quaternion a = unit(from), b = unit(to);
    Quaternion step = product({-a[0], -a[1], -a[2], a[3]}, b);
    if (step[3] < 0)
        for (double& x : step) x = -x;
    const double length = std::hypot(step[0], step[1], step[2]);
    if (length == 0) return a;
    const double angle = std::atan2(length, step[3]) * u, share = std::sin(angle) / length;
    return product(a, {step[0] * share, step[1] * share, step[2] * share, std::cos(angle)});
}

/// Values of one sampler.
struct Track {
    std::vector<double> times, values;
    std::string mode;
    size_t width = 0;

    [[nodiscard]] std::vector<double> row(size_t key, size_t part, size_t parts) const {
        const auto first = values.begin() + std::ptrdiff_t((key * parts + part) * width);
        return {first, first + std::ptrdiff_t(width)};
    }

    [[nodiscard]] std::vector<double> at(double time, bool rotates) const {
        const bool spline = mode == "CUBICSPLINE";
        const size_t parts = spline ? 3 : 1, middle = spline ? 1 : 0;
        size_t key = 0;
        for (size_t i = 0; i < times.size(); ++i)
            if (times[i] <= time) key = i;
        std::vector<double> a = row(key, middle, parts);
        if (time >= times[0] && key + 1 < times.size() && mode != "STEP") {
            const double step = times[key + 1] - times[key], u = (time - times[key]) / step;
            const std::vector<double> b = row(key + 1, middle, parts);
            if (spline) {
                const auto out = row(key, 2, parts), in = row(key + 1, 0, parts);
                for (size_t k = 0; k < width; ++k)
                    a[k] =
                        bezier({a[k], a[k] + step * out[k] / 3, b[k] - step * in[k] / 3, b[k]}, u);
            } else if (rotates) {
                const auto q = turned({a[0], a[1], a[2], a[3]}, {b[0], b[1], b[2], b[3]}, u);
                a.assign(q.begin(), q.end());
            } else {
                for (size_t k = 0; k < width; ++k) a[k] = (1 - u) * a[k] + u * b[k];
            }
        }
        return a;
    }

    /// De Casteljau's cuts.
    [[nodiscard]] static double bezier(std::array<double, 4> p, double u) {
        for (size_t last = 3; last > 0; --last)
            for (size_t i = 0; i < last; ++i) p[i] += u * (p[i + 1] - p[i]);
        return p[0];
    }
};

[[nodiscard]] inline Columns product(const Columns& a, const Columns& b) {
    Columns out{};
    for (size_t c = 0; c < 4; ++c)
        for (size_t r = 0; r < 4; ++r)
            for (size_t k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return out;
}

/// The rotation by Rodrigues's formula, from axis and angle.
[[nodiscard]] inline Columns rotation(const Quaternion& q) {
    const double length = std::hypot(q[0], q[1], q[2]), angle = 2 * std::atan2(length, q[3]);
    const double c = std::cos(angle), s = std::sin(angle);
    Three n{};
    for (size_t k = 0; k < 3 && length > 0; ++k) n[k] = q[k] / length;
    const std::array<Three, 3> cross = {{{0, n[2], -n[1]}, {-n[2], 0, n[0]}, {n[1], -n[0], 0}}};
    Columns m{};
    for (size_t column = 0; column < 3; ++column)
        for (size_t r = 0; r < 3; ++r)
            m[4 * column + r] =
                (column == r ? c : 0) + s * cross[column][r] + (1 - c) * n[column] * n[r];
    m[15] = 1;
    return m;
}

[[nodiscard]] inline Three moved(const Columns& m, const Three& p, double w) {
    Three out{};
    for (size_t r = 0; r < 3; ++r)
        out[r] = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r] * w;
    return out;
}

/// n times the inverse of the matrix, which is the inverse transpose times n; of length 1.
[[nodiscard]] inline Three moved_normal(const Columns& m, const Three& n) {
    const auto at = [&](size_t r, size_t c) { return m[4 * (c % 3) + r % 3]; };
    double determinant = 0;
    for (size_t c = 0; c < 3; ++c)
        determinant += at(0, c) * (at(1, c + 1) * at(2, c + 2) - at(1, c + 2) * at(2, c + 1));
    Three out{};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c)
            out[r] += n[c] / determinant *
                      (at(r + 1, c + 1) * at(r + 2, c + 2) - at(r + 1, c + 2) * at(r + 2, c + 1));
    const double length = std::hypot(out[0], out[1], out[2]);
    for (double& x : out) x /= length;
    return out;
}

/// Vertices of a primitive in the scene.
struct Shape {
    std::vector<Three> positions, normals;
};

/// A glTF file that is sound, with its animations.
class AnimationTruth {
  public:
    AnimationTruth(nlohmann::json root, std::vector<std::vector<uint8_t>> buffers)
        : root_(std::move(root)), buffers_(std::move(buffers)) {
        const auto& nodes = root_.at("nodes");
        parent_.assign(nodes.size(), nodes.size());
        for (size_t n = 0; n < nodes.size(); ++n)
            for (const size_t child : nodes[n].value("children", std::vector<size_t>()))
                parent_[child] = n;
    }

    /// Moves the nodes to a time from the animation's start.
    void play(size_t number, double time) {
        const auto& animation = root_.at("animations").at(number);
        for (const auto& channel : animation.at("channels")) {
            const auto& sampler = animation.at("samplers").at(channel.at("sampler").get<size_t>());
            Track track{numbers(sampler.at("input")), numbers(sampler.at("output")),
                        sampler.value("interpolation", "LINEAR")};
            track.width = track.values.size() / track.times.size();
            if (track.mode == "CUBICSPLINE") track.width /= 3;
            const auto& target = channel.at("target");
            const std::string path = target.at("path");
            root_["nodes"][target.at("node").get<size_t>()][path] =
                track.at(time, path == "rotation");
        }
    }

    [[nodiscard]] Columns world(size_t node) const {
        const Columns own = local(root_["nodes"][node]);
        return parent_[node] < parent_.size() ? product(world(parent_[node]), own) : own;
    }

    /// Of all nodes with a mesh.
    [[nodiscard]] std::vector<Shape> shapes() const {
        std::vector<Shape> out;
        for (size_t n = 0; n < parent_.size(); ++n) {
            const auto& node = root_["nodes"][n];
            if (!node.contains("mesh")) continue;
            const auto& mesh = root_["meshes"][node["mesh"].get<size_t>()];
            for (const auto& primitive : mesh["primitives"])
                out.push_back(shape(n, node, mesh, primitive));
        }
        return out;
    }

    /// Components of an accessor, one after another.
    [[nodiscard]] std::vector<double> numbers(size_t index) const {
        const auto& accessor = root_["accessors"][index];
        const size_t width = width_of(accessor), count = accessor["count"];
        std::vector<double> out(count * width, 0.);
        for (size_t i = 0; accessor.contains("bufferView") && i < count; ++i)
            for (size_t k = 0; k < width; ++k)
                out[i * width + k] = number(accessor, accessor, i, k);
        if (!accessor.contains("sparse")) return out;
        const auto& sparse = accessor["sparse"];
        for (size_t i = 0; i < sparse["count"].get<size_t>(); ++i) {
            nlohmann::json one = {{"componentType", sparse["indices"]["componentType"]},
                                  {"type", "SCALAR"}};
            const auto at = size_t(number(one, sparse["indices"], i, 0));
            for (size_t k = 0; k < width; ++k)
                out[at * width + k] = number(accessor, sparse["values"], i, k);
        }
        return out;
    }

    /// The file's JSON, with the values of the time that is played.
    [[nodiscard]] const nlohmann::json& root() const { return root_; }

    /// Of each vertex of a primitive with joints, as the nodes stand.
    [[nodiscard]] std::vector<Columns> skin_matrices(const nlohmann::json& skin,
                                                     const nlohmann::json& attributes,
                                                     size_t vertices) const {
        std::vector<Columns> of_joint;
        for (const size_t node : skin["joints"]) of_joint.push_back(world(node));
        if (skin.contains("inverseBindMatrices")) {
            const std::vector<double> all = numbers(skin["inverseBindMatrices"]);
            for (size_t j = 0; j < of_joint.size(); ++j) {
                Columns inverse;
                std::copy_n(all.begin() + std::ptrdiff_t(16 * j), 16, inverse.begin());
                of_joint[j] = product(of_joint[j], inverse);
            }
        }
        std::vector<Columns> out(vertices, Columns{});
        std::vector<double> total(vertices, 0.);
        for (int set = 0; attributes.contains("JOINTS_" + std::to_string(set)); ++set) {
            const auto joints = numbers(attributes["JOINTS_" + std::to_string(set)]);
            const auto weights = numbers(attributes["WEIGHTS_" + std::to_string(set)]);
            for (size_t i = 0; i < weights.size(); ++i) {
                for (size_t k = 0; k < 16; ++k)
                    out[i / 4][k] += weights[i] * of_joint[size_t(joints[i])][k];
                total[i / 4] += weights[i];
            }
        }
        for (size_t v = 0; v < vertices; ++v)
            for (double& x : out[v]) x /= total[v];
        return out;
    }

  private:
    [[nodiscard]] static size_t width_of(const nlohmann::json& accessor) {
        const std::string type = accessor.at("type");
        return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type.back() - '0');
    }

    template <class T>
    [[nodiscard]] static double scaled(const uint8_t* at, bool normalised) {
        T raw;
        std::memcpy(&raw, at, sizeof raw);
        if (!normalised) return double(raw);
        const double share = double(raw) / double(std::numeric_limits<T>::max());
        return share < -1 ? -1 : share;
    }

    /// Component k of element i, where `place` has bufferView and byteOffset.
    [[nodiscard]] double number(const nlohmann::json& format, const nlohmann::json& place, size_t i,
                                size_t k) const {
        const auto& view = root_["bufferViews"][place.at("bufferView").get<size_t>()];
        const int type = format.at("componentType");
        const size_t size = type < 5122 ? 1 : type < 5124 ? 2 : 4;
        const size_t stride = view.value("byteStride", width_of(format) * size);
        const uint8_t* at = &buffers_.at(view.at("buffer").get<size_t>())
                                 .at(view.value("byteOffset", size_t(0)) +
                                     place.value("byteOffset", size_t(0)) + i * stride + k * size);
        const bool normalised = format.value("normalized", false);
        switch (type) {
            case 5120:
                return scaled<int8_t>(at, normalised);
            case 5121:
                return scaled<uint8_t>(at, normalised);
            case 5122:
                return scaled<int16_t>(at, normalised);
            case 5123:
                return scaled<uint16_t>(at, normalised);
            case 5125:
                return scaled<uint32_t>(at, false);
            default:
                return scaled<float>(at, false);
        }
    }

    [[nodiscard]] static Columns local(const nlohmann::json& node) {
        if (node.contains("matrix")) return node["matrix"].get<Columns>();
        const Three t = node.value("translation", Three{0, 0, 0});
        const Three s = node.value("scale", Three{1, 1, 1});
        Columns move = rotation(unit(node.value("rotation", Quaternion{0, 0, 0, 1})));
        std::copy(t.begin(), t.end(), move.begin() + 12);
        return product(move, {s[0], 0, 0, 0, 0, s[1], 0, 0, 0, 0, s[2], 0, 0, 0, 0, 1});
    }

    [[nodiscard]] std::vector<Three> threes(size_t accessor) const {
        const std::vector<double> all = numbers(accessor);
        std::vector<Three> out(all.size() / 3);
        for (size_t i = 0; i < all.size(); ++i) out[i / 3][i % 3] = all[i];
        return out;
    }

    [[nodiscard]] Shape shape(size_t index, const nlohmann::json& node, const nlohmann::json& mesh,
                              const nlohmann::json& primitive) const {
        const auto& attributes = primitive["attributes"];
        const auto weights = node.value("weights", mesh.value("weights", std::vector<double>()));
        const auto read = [&](const char* name) {
            if (!attributes.contains(name)) return std::vector<Three>();
            std::vector<Three> out = threes(attributes[name]);
            for (size_t t = 0; t < weights.size(); ++t)
                if (const auto& target = primitive["targets"][t]; target.contains(name)) {
                    const std::vector<Three> by = threes(target[name]);
                    for (size_t i = 0; i < out.size(); ++i)
                        for (size_t k = 0; k < 3; ++k) out[i][k] += weights[t] * by[i][k];
                }
            return out;
        };
        Shape out{read("POSITION"), read("NORMAL")};
        const bool skinned = node.contains("skin") && attributes.contains("JOINTS_0");
        const std::vector<Columns> each =
            skinned ? skin_matrices(root_["skins"][node["skin"].get<size_t>()], attributes,
                                    out.positions.size())
                    : std::vector<Columns>(out.positions.size(), world(index));
        for (size_t i = 0; i < out.positions.size(); ++i) {
            out.positions[i] = moved(each[i], out.positions[i], 1);
            if (!out.normals.empty()) out.normals[i] = moved_normal(each[i], out.normals[i]);
        }
        return out;
    }

    nlohmann::json root_;
    std::vector<std::vector<uint8_t>> buffers_;
    std::vector<size_t> parent_;
};

}  // namespace petzval::test
