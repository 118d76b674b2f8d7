// SPDX-License-Identifier: Apache-2.0
// Tiny glTF files that move, and what the loader makes of them at a time.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "io/gltf/gltf.h"
#include "tests/support/animation/truth.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::test {

[[nodiscard]] inline nlohmann::json node_target(int node, const char* path) {
    return {{"node", node}, {"path", path}};
}

[[nodiscard]] inline nlohmann::json pointer_target(const std::string& pointer) {
    return {{"path", "pointer"},
            {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

struct AnimatedGltf : TinyGltf {
    /// A mesh whose vertices are the origin and the ends of the axes, so that they tell all of a
    /// matrix; more: e.g. {{"material", 0}}.
    int add_probe(nlohmann::json more = nlohmann::json::object()) {
        more["attributes"]["POSITION"] = add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
        more["attributes"]["NORMAL"] =
            add_accessor<float>("VEC3", {0, 0, 1, 1, 0, 0, 0, 1, 0, 0.6f, 0, 0.8f});
        more["indices"] = add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
        return add_mesh(std::move(more));
    }

    int add_animation(const std::string& name = "") {
        return add("animations", {{"name", name},
                                  {"samplers", nlohmann::json::array()},
                                  {"channels", nlohmann::json::array()}});
    }

    /// A channel of the last animation with a sampler of its own; output: an accessor.
    void add_channel_to(int output, nlohmann::json target, const std::vector<float>& times,
                        const char* mode = "LINEAR") {
        if (!json.contains("animations")) add_animation();
        nlohmann::json& animation = json["animations"].back();
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", std::move(target)}});
        animation["samplers"].push_back({{"input", add_accessor<float>("SCALAR", times)},
                                         {"output", output},
                                         {"interpolation", mode}});
    }

    template <class T = float>
    void add_channel(nlohmann::json target, const std::vector<float>& times, const char* type,
                     const std::vector<T>& values, const char* mode = "LINEAR") {
        const bool share = !std::is_same_v<T, float>;
        add_channel_to(add_accessor<T>(type, values, {{"normalized", share}}), std::move(target),
                       times, mode);
    }
};

[[nodiscard]] inline io::GltfFile load_at(const std::filesystem::path& path,
                                          const io::AnimationChoice& choice) {
    io::PictureBudget pictures;
    io::GltfChoices choices;
    choices.animation = choice;
    return io::load_gltf(path, io::FileScope::Anywhere, pictures, choices);
}

[[nodiscard]] inline io::GltfFile load_at(const TinyGltf& file, const io::AnimationChoice& choice) {
    const TempFolder folder;
    return load_at(file.save_glb(folder.path / "test.glb"), choice);
}

[[nodiscard]] inline io::AnimationChoice moment(double time_s,
                                                std::vector<std::string> names = {}) {
    return {time_s, std::move(names), true};
}

[[nodiscard]] inline io::GltfFile load_at(const TinyGltf& file, double time_s) {
    return load_at(file, moment(time_s));
}

/// Vertices of a loaded instance, in the scene.
[[nodiscard]] inline Shape shape_of(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes.at(instance.mesh);
    Columns move{};
    for (size_t k = 0; k < 16; ++k) move[k] = double(instance.to_world.getValue()[k]);
    Shape out;
    for (const V3f& p : mesh.positions) out.positions.push_back(moved(move, {p.x, p.y, p.z}, 1));
    for (const V3f& n : mesh.normals) out.normals.push_back(moved_normal(move, {n.x, n.y, n.z}));
    return out;
}

/// Greatest distance of two lists of equal length; infinite for others.
[[nodiscard]] inline double apart(const std::vector<Three>& a, const std::vector<Three>& b) {
    if (a.size() != b.size()) return HUGE_VAL;
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i)
        for (size_t k = 0; k < 3; ++k) most = std::max(most, std::fabs(a[i][k] - b[i][k]));
    return most;
}

/// A float's step at the greatest coordinate, times `steps`: the loader computes in doubles and
/// stores floats, so that half a step is due to it; morph targets are summed in floats.
[[nodiscard]] inline double float_tolerance(const std::vector<Shape>& shapes, double steps) {
    double most = 1;
    for (const Shape& shape : shapes)
        for (const Three& p : shape.positions)
            for (const double x : p) most = std::max(most, std::fabs(x));
    return most * steps * std::numeric_limits<float>::epsilon();
}

/// Expects that the instances stand where the shapes do, in whatever order.
inline void expect_shapes(const std::vector<Shape>& wanted, const io::GltfFile& file,
                          double steps = 2) {
    const double tolerance = float_tolerance(wanted, steps);
    const double of_normals = 2 * steps * std::numeric_limits<float>::epsilon();
    std::vector<Shape> left = wanted;
    for (const Instance& instance : file.scene.instances) {
        const Shape shape = shape_of(file.scene, instance);
        double nearest = HUGE_VAL, normals = HUGE_VAL;
        auto best = left.end();
        for (auto at = left.begin(); at != left.end(); ++at)
            if (const double distance = apart(at->positions, shape.positions); distance < nearest) {
                nearest = distance;
                normals = at->normals.empty() ? 0 : apart(at->normals, shape.normals);
                best = at;
            }
        EXPECT_LE(nearest, tolerance);
        EXPECT_LE(normals, of_normals);
        if (best != left.end()) left.erase(best);
    }
    EXPECT_TRUE(left.empty()) << left.size() << " shapes are not shown";
}

/// Expects that a file's first animation shows at each time what the reference does; the times lie
/// in the animation.
inline void expect_truth(const TinyGltf& file, const std::vector<double>& times, double steps = 2) {
    for (const double time : times) {
        SCOPED_TRACE(time);
        AnimationTruth truth(file.json, {file.bin});
        truth.play(0, time);
        expect_shapes(truth.shapes(), load_at(file, time), steps);
    }
}

}  // namespace petzval::test
