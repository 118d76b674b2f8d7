// SPDX-License-Identifier: Apache-2.0
// What the loader says of how far meshes are off between time steps, against stills at random
// times.
#include <gtest/gtest.h>

#include "io/gltf/animation/node_motion.h"
#include "tests/support/moving_gltf.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using namespace test;

struct Case {
    const char* name;
    TinyGltf file;
};

int add_wedge(TinyGltf& file, json more = json::object()) {
    more["attributes"]["POSITION"] =
        file.add_positions({-1, -1, 0, 1, -1, 0, 0, 1, 0.2f, 0.3f, 0.2f, 1});
    more["indices"] = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 1, 3, 2});
    return file.add_mesh(std::move(more));
}

TinyGltf wheel(double degrees, float arm = 0) {
    TinyGltf file;
    const int hub = file.add_root({{"children", {1}}});
    file.add("nodes", {{"mesh", add_wedge(file)}, {"translation", {arm, 0, 0}}});
    spin(file, hub, V3d(0.2, 1, 0.1).normalized(), degrees);
    return file;
}

/// Bones that hang on each other, each swinging beside its own rhythm; the mesh hangs on the last
/// as a child, or on all of them by a skin.
TinyGltf chain(bool by_skin) {
    constexpr int kBones = 4;
    TinyGltf file;
    const int root = file.add_root({{"children", {1}}});
    for (int i = 0; i < kBones; ++i) {
        json node{{"translation", {0, 1, 0}}};
        if (i + 1 < kBones) node["children"] = {i + 2};
        file.add("nodes", node);
    }
    for (int i = 0; i <= kBones; ++i) {
        std::vector<float> times, values;
        for (int k = 0; k <= 7 + i; ++k) {
            times.push_back(float(k) / float(7 + i));
            const auto q =
                quaternion(i % 2 ? V3d(0, 0, 1) : V3d(1, 0, 0), (k % 2 ? 40 : -25) + 3 * k);
            values.insert(values.end(), q.begin(), q.end());
        }
        animate(file, root + i, "rotation", times, values);
    }
    if (!by_skin) {
        file.json["nodes"][kBones]["mesh"] = add_wedge(file);
        return file;
    }
    const int joints =
        file.add_accessor<uint8_t>("VEC4", {0, 1, 2, 3, 3, 2, 1, 0, 3, 0, 0, 0, 2, 3, 0, 0});
    const int weights = file.add_accessor<float>(
        "VEC4", {0.25f, 0.25f, 0.25f, 0.25f, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
    const int mesh =
        add_wedge(file, {{"attributes", {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}});
    file.add("skins", {{"joints", {1, 2, 3, 4}}});
    file.add_root({{"mesh", mesh}, {"skin", 0}});
    return file;
}

/// A kink between two steps, and a jump.
TinyGltf path(const char* interpolation) {
    TinyGltf file;
    const int node = file.add_root({{"mesh", add_wedge(file)}});
    animate(file, node, "translation", {0, 0.4437f, 0.701f, 1},
            {0, 0, 0, 4, 0, 1, -3, 2, 0, 0, 0, 9}, interpolation);
    return file;
}

/// Two morph targets whose weights swing; node: of the mesh.
TinyGltf morph(json node, bool node_turns, bool skinned) {
    TinyGltf file;
    const int one = file.add_accessor<float>("VEC3", {0, 0, 0, 0, 1, 0, 0, 0, 0.5f, 1, 0, 0});
    const int two = file.add_accessor<float>("VEC3", {2, 0, 0, 0, 0, -1, 0, 0, 0.5f, 0, 0, 3});
    json more{{"targets", json::array({{{"POSITION", one}}, {{"POSITION", two}}})}};
    if (skinned) {
        more["attributes"]["JOINTS_0"] =
            file.add_accessor<uint8_t>("VEC4", std::vector<uint8_t>(16));
        more["attributes"]["WEIGHTS_0"] =
            file.add_accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    }
    node["mesh"] = add_wedge(file, more);
    if (skinned) node["skin"] = 0;
    const int index = file.add_root(node);
    std::vector<float> times, values;
    for (int k = 0; k <= 12; ++k) {
        times.push_back(float(k) / 12);
        values.push_back(k % 2 ? 0.9f : 0.1f);
        values.push_back(0.5f + 0.5f * std::cos(float(k)));
    }
    animate(file, index, "weights", times, values);
    if (skinned) {
        const int bone = file.add_root({{"scale", {3, 3, 3}}});
        file.add("skins", {{"joints", {bone}}});
        spin(file, bone, V3d(0, 0, 1), 40);
    }
    if (node_turns) spin(file, index, V3d(0, 0, 1), 40);
    return file;
}

std::vector<Case> cases() {
    TinyGltf moved_mesh = wheel(150, 4);
    return {
        {"a slow wheel", wheel(10)},
        {"a wheel", wheel(200)},
        {"a wheel on an arm", wheel(200, 5)},
        {"a fast wheel", wheel(3 * 360, 2)},
        {"a chain", chain(false)},
        {"a chain with a skin", chain(true)},
        {"kinks", path("LINEAR")},
        {"jumps", path("STEP")},
        {"morph targets", morph(json::object(), false, false)},
        {"morph targets on a large node", morph({{"scale", {50, 50, 50}}}, false, false)},
        {"morph targets on a node that turns", morph(json::object(), true, false)},
        {"morph targets on a large node that turns", morph({{"scale", {50, 50, 50}}}, true, false)},
        {"morph targets with a skin", morph(json::object(), false, true)}};
}

/// The number after "off by at most", in metres.
double said_m(const GltfFile& file) {
    const std::string mark = "off by at most ";
    for (const std::string& line : file.remarks)
        if (const size_t at = line.find(mark); at != line.npos)
            return std::stod(line.substr(at + mark.size()));
    return 0;
}

TEST(GltfMotionBound, HoldsAtRandomTimes) {
    for (const auto& [name, file] : cases()) {
        const SavedGltf saved(file);
        for (const double open_s : {1., 0.3}) {
            const GltfFile open = saved.at(0.5, open_s, false);
            const double said = said_m(open);
            Random random(1);
            double most = 0;
            for (int i = 0; i < 150; ++i) {
                const float time = random.next();
                const GltfFile still = saved.at(0.5 + (double(time) - 0.5) * open_s, 0, false);
                most = std::max(
                    most, apart(triangles_at(open.scene, time), triangles_at(still.scene, 0.5f)));
            }
            // Two digits are said, and coordinates are rounded to floats.
            EXPECT_LE(most, 1.05 * said + 1e-5) << name << ", open for " << open_s << " s";
            if (getenv("SHOW"))
                printf("%-45s %4g said %-9.3g true %.3g\n", name, open_s, said, most);
        }
    }
}

}  // namespace
}  // namespace petzval
