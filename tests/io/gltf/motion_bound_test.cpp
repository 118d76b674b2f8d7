// SPDX-License-Identifier: Apache-2.0
// What the loader says of how far meshes are off between time steps, against stills at random
// times.
#include <gtest/gtest.h>

#include "io/gltf/animation/thinning.h"
#include "tests/support/moving_gltf.h"
#include "tests/support/statistics.h"

namespace petzval::io {
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
            // Coordinates are rounded to floats.
            EXPECT_LE(most, said + 1e-5) << name << ", open for " << open_s << " s";
        }
    }
}

// What no step sees cannot be bounded; it is said that there may be some.
TEST(GltfMotionBound, IsNotGivenAloneWhereKeysLieBetweenSteps) {
    const auto says = [](const TinyGltf& file, double open_s) {
        return contains_line(SavedGltf(file).at(0.5, open_s).remarks, "keys lie closer");
    };
    TinyGltf spike, flick, calm, late;
    for (TinyGltf* file : {&spike, &flick, &calm, &late})
        file->add_root({{"mesh", add_wedge(*file)}});
    animate(spike, 0, "translation", {0, 0.5005f, 0.503f, 0.5055f, 1},
            {0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0});
    animate(flick, 0, "translation", {0, 0.5005f, 0.5055f, 1}, {0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0},
            "STEP");
    animate(calm, 0, "translation", {0, 0.5005f, 0.503f, 0.5055f, 1},
            {0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0});
    animate(late, 0, "translation", {0, 0.9f, 0.903f, 1}, {0, 0, 0, 1, 0, 0, 4, 0, 0, 1, 0, 0});
    EXPECT_TRUE(says(spike, 1));
    EXPECT_TRUE(says(flick, 1));
    EXPECT_FALSE(says(calm, 1));  // these keys are equal
    EXPECT_FALSE(says(spike, 0.1));
    EXPECT_FALSE(says(late, 0.5));
    EXPECT_TRUE(says(late, 0.9));
    for (const double turns : {64., 127., 128.}) EXPECT_TRUE(says(wheel(turns * 360), 1)) << turns;
    EXPECT_FALSE(says(wheel(3 * 360), 1));
    EXPECT_FALSE(says(wheel(40 * 360), 1));
}

/// Greatest distance of the chosen steps' chords from all steps, by another way than thin().
double chord_error(const std::vector<M44d>& all, size_t stride, const std::vector<V3d>& points) {
    double most = 0;
    for (size_t i = 0; i < all.size(); ++i)
        for (const V3d& p : points) {
            const size_t k = i / stride * stride, next = std::min(k + stride, all.size() - 1);
            const double share = next == k ? 0 : double(i - k) / double(next - k);
            const V3d chord = p * all[k] * (1 - share) + p * all[next] * share;
            most = std::max(most, (p * all[i] - chord).length());
        }
    return most;
}

TEST(GltfMotionBound, ThinningTakesTheFewestStepsThatStayWithinAThousandth) {
    const std::vector<V3d> points{V3d(0.), V3d(1, 0, 0), V3d(0.3, 2, 0.1)};
    for (const double degrees : {0.001, 5., 50., 200., 1500., 20000.}) {
        std::vector<M44d> all(129);
        for (size_t i = 0; i < all.size(); ++i)
            all[i].setEulerAngles(V3d(0, degrees * M_PI / 180 * double(i) / 128, 0.2));
        const Thinning thinning = thin(all, points);
        ASSERT_EQ(128 % thinning.stride, 0u);
        const double bound = 1e-3 * thinning.size_m;
        if (thinning.stride > 1) {
            EXPECT_LE(chord_error(all, thinning.stride, points), bound * (1 + 1e-9)) << degrees;
        }
        if (thinning.stride < 128) {
            EXPECT_GT(chord_error(all, thinning.stride * 2, points), bound) << degrees;
        }
        EXPECT_GE(thinning.off_m, chord_error(all, thinning.stride, points)) << degrees;
    }
}

// Wheels on turning arms: together they turn by up to half a turn in a time step, about any axes.
TEST(GltfMotionBound, HoldsForChainsThatTurnByHalfATurnInAStep) {
    Random random(1);
    const auto unit_vector = [&] {
        V3d v;
        do v = V3d(random.next(), random.next(), random.next()) * 2. - V3d(1.);
        while (v.length() < 0.1);
        return v.normalized();
    };
    const std::vector<V3d> points{V3d(0.), V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)};
    for (int trial = 0; trial < 400; ++trial) {
        const int nodes = 1 + trial % 3;
        std::vector<V3d> axes, arms;
        std::vector<double> shares;
        double sum = 0;
        for (int k = 0; k < nodes; ++k) {
            axes.push_back(unit_vector());
            arms.push_back(unit_vector() * (2. * double(random.next())));
            shares.push_back(double(random.next()));
            sum += shares.back();
        }
        const double total_rad = M_PI * double(random.next());  // in a step
        const auto place = [&](double step) {
            M44d out;
            for (size_t k = 0; k < axes.size(); ++k) {
                M44d turn, arm;
                turn.setAxisAngle(axes[k], step * total_rad * shares[k] / sum);
                arm.setTranslation(arms[k]);
                out = out * turn * arm;
            }
            return out;
        };
        std::vector<M44d> all;
        for (int i = 0; i <= 128; ++i) all.push_back(place(i));
        const Thinning thinning = thin(all, points);
        double most = 0;
        for (int i = 0; i < 128 * 8; ++i) {
            const double at = i / 8.;
            const size_t before = static_cast<size_t>(at) / thinning.stride * thinning.stride;
            const double share = (at - double(before)) / double(thinning.stride);
            for (const V3d& p : points)
                most = std::max(most, (p * place(at) - p * all[before] * (1 - share) -
                                       p * all[before + thinning.stride] * share)
                                          .length());
        }
        EXPECT_LE(most, thinning.off_m) << trial << ", " << nodes << " nodes, " << total_rad;
    }
}

// Each of two turns by less than steps can tell; together they come back to where they were.
TEST(GltfMotionBound, IsNotGivenAloneWhereAChainTurnsTooFast) {
    const auto says = [](const TinyGltf& file) {
        return contains_line(SavedGltf(file).at(0.5, 1).remarks, "half a turn");
    };
    const auto chain = [](double turns) {
        TinyGltf file;
        const int mesh = add_wedge(file);
        const int wheel = file.add("nodes", {{"mesh", mesh}});
        const int arm = file.add_root({{"children", {wheel}}});
        std::vector<float> times, keys;
        const int count = static_cast<int>(turns * 4);
        for (int i = 0; i <= count; ++i) {
            times.push_back(float(i) / float(count));
            const double half_rad = M_PI * turns * i / count;
            keys.insert(keys.end(), {0, 0, float(std::sin(half_rad)), float(std::cos(half_rad))});
        }
        animate(file, wheel, "rotation", times, keys);
        animate(file, arm, "rotation", times, keys);
        return file;
    };
    EXPECT_TRUE(says(chain(40)));  // 225 degrees together
    EXPECT_FALSE(says(chain(25)));
}

TEST(GltfMotionBound, ThinningOfWeightsAddsUpWhatTargetsDo) {
    std::vector<std::vector<double>> straight, bent;
    for (int i = 0; i <= 128; ++i) {
        const double s = i / 128.;
        straight.push_back({s, 1 - 3 * s});
        bent.push_back({s * s, 4 * s * (1 - s)});
    }
    const std::vector<double> sizes{2, 0.5};
    EXPECT_EQ(thin(straight, sizes, 1).stride, 128u);
    EXPECT_NEAR(thin(straight, sizes, 1).off_m, 0, 1e-12);
    // Between chosen steps that are k apart the sum is off by (2 + 4 / 2) (k / 128)^2 / 4.
    const Thinning thinning = thin(bent, sizes, 1);
    EXPECT_EQ(thinning.stride, 4u);
    EXPECT_NEAR(thinning.off_m, 4 / 4. / 1024 + 8 / 128. / 128, 1e-9);
    EXPECT_EQ((Thinning{8, 1, 2} | Thinning{4, 3, 1}).stride, 4u);
    EXPECT_EQ((Thinning{8, 1, 2} | Thinning{4, 3, 1}).off_m, 3);
}

}  // namespace
}  // namespace petzval::io
