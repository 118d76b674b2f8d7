// SPDX-License-Identifier: Apache-2.0
// A mesh that swings while the shutter is open, and what tests of motion ask of a scene.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/moving_gltf.h"

namespace petzval::test {

inline constexpr double kAt = 0.5, kOpen = 0.5;
inline const V3d kAxis = V3d(1, 2, -0.5).normalized();

/// A mesh of two triangles with normals.
inline int add_wedge(TinyGltf& file, json more = json::object()) {
    more["attributes"]["POSITION"] =
        file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0.2f, 0.3f, 0.2f, 1});
    more["attributes"]["NORMAL"] =
        file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0.6f, 0.8f, 1, 0, 0, 0, 1, 0});
    more["indices"] = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 1, 3, 2});
    return file.add_mesh(std::move(more));
}

/// Swings a node; its path has a kink in the middle of the exposure, where a step lies.
inline void swing(TinyGltf& file, int node) {
    spin(file, node, kAxis, 90);
    animate(file, node, "translation", {0, 0.5f, 1}, {0, 0, 0, 1, 2, 0, 3, 0, -1});
}

inline size_t deforming(const Scene& scene) {
    return static_cast<size_t>(std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                             [](const Mesh& m) { return !m.steps.empty(); }));
}
inline size_t moving(const Scene& scene) {
    return static_cast<size_t>(std::count_if(scene.instances.begin(), scene.instances.end(),
                                             [](const Instance& i) { return i.moves; }));
}

inline void expect_still(const io::GltfFile& file) {
    EXPECT_EQ(moving(file.scene), 0u);
    EXPECT_EQ(deforming(file.scene), 0u);
    EXPECT_TRUE(file.scene.motions.empty());
    EXPECT_TRUE(file.scene.light_motions.empty());
    for (const io::GltfCamera& camera : file.cameras) EXPECT_TRUE(camera.steps.empty());
    EXPECT_FALSE(has_motion(file.scene));
}

/// A channel that moves what a pointer names, from `first` at 0 s to `last` at 1 s.
inline void animate_pointer(TinyGltf& file, const std::string& pointer, const char* type,
                            const std::vector<float>& first, const std::vector<float>& last) {
    std::vector<float> values = first;
    values.insert(values.end(), last.begin(), last.end());
    json& animation = file.json["animations"][0];
    animation["samplers"].push_back({{"input", file.add_accessor<float>("SCALAR", {0, 1})},
                                     {"output", file.add_accessor<float>(type, values)}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1},
         {"target",
          {{"path", "pointer"},
           {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
}

}  // namespace petzval::test
