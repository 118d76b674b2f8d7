// SPDX-License-Identifier: Apache-2.0
// How values run between the keys of an animation: glTF 2.0, appendix C.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/animation/animated_gltf.h"

namespace petzval::test {
namespace {

using nlohmann::json;

constexpr float kHalf = 0.70710678f;  ///< sine and cosine of half a right angle

/// Times before, at, between and behind keys at 0.5, 1, 1.75 and 3.
const std::vector<float> kTimes = {0.5f, 1, 1.75f, 3};
const std::vector<double> kLooks = {0, 0.3, 0.5, 0.6, 0.75, 1, 1.2, 1.7, 1.75, 2, 2.4, 2.99};

AnimatedGltf probe(json node = json::object()) {
    AnimatedGltf file;
    node["mesh"] = file.add_probe();
    file.add_root(std::move(node));
    return file;
}

/// The probe's vertex of a file with nothing else.
V3f vertex(const TinyGltf& file, double time_s, size_t number) {
    return load_at(file, time_s).scene.meshes.at(0).positions.at(number);
}

TEST(AnimationKeys, AStraightLineIsHalfwayAtHalfTime) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {0, 2}, "VEC3", {0, 0, 0, 8, -4, 2});
    EXPECT_EQ(vertex(file, 1, 0), V3f(4, -2, 1));
    EXPECT_EQ(vertex(file, 0.5, 0), V3f(2, -1, 0.5f));
    EXPECT_EQ(vertex(file, 0, 0), V3f(0));
}

TEST(AnimationKeys, AStepStaysUntilItsNextKey) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {0, 1, 2}, "VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0},
                     "STEP");
    EXPECT_EQ(vertex(file, 0.999, 0).x, 1);
    EXPECT_EQ(vertex(file, 1, 0).x, 2);
    EXPECT_EQ(vertex(file, 1.999, 0).x, 2);
}

TEST(AnimationKeys, ASplineLeavesAndArrivesWithItsTangents) {
    // x(u) = 8 u (1 - u)^2 + 4 u^2 (u - 1), as the tangents are 4 and 2 a second for 2 s.
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {0, 2}, "VEC3",
                     {9, 9, 9, 0, 0, 0, 4, 0, 0, 2, 0, 0, 0, 0, 0, 9, 9, 9}, "CUBICSPLINE");
    EXPECT_FLOAT_EQ(vertex(file, 1, 0).x, 0.5f);
    EXPECT_FLOAT_EQ(vertex(file, 0.5, 0).x, 0.9375f);
    EXPECT_FLOAT_EQ(vertex(file, 1.5, 0).x, -0.1875f);
}

TEST(AnimationKeys, ARotationTurnsEvenly) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "rotation"), {0, 3}, "VEC4", {0, 0, 0, 1, 0, 0, kHalf, kHalf});
    const V3f third = vertex(file, 1, 1);  // 30 of 90 degrees
    EXPECT_NEAR(third.x, std::sqrt(0.75), 1e-7);
    EXPECT_NEAR(third.y, 0.5, 1e-7);
}

TEST(AnimationKeys, ARotationGoesTheShortWay) {
    // The second key is the same turn by 90 degrees, but the other way round 270.
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "rotation"), {0, 3}, "VEC4",
                     {0, 0, 0, 1, 0, 0, -kHalf, -kHalf});
    const V3f third = vertex(file, 1, 1);
    EXPECT_NEAR(third.x, std::sqrt(0.75), 1e-7);
    EXPECT_NEAR(third.y, 0.5, 1e-7);
    expect_truth(file, kLooks);
}

class Modes : public testing::TestWithParam<const char*> {
  protected:
    /// Numbers for the keys of kTimes, with tangents where the mode has some.
    [[nodiscard]] static std::vector<float> rows(size_t width, float low, float high) {
        const size_t parts = std::string(GetParam()) == "CUBICSPLINE" ? 3 : 1;
        std::vector<float> out(kTimes.size() * parts * width);
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = low + (high - low) * float(std::fmod(0.371 + 0.6180339887 * double(i), 1));
        return out;
    }
};

TEST_P(Modes, TranslationAgreesWithTheReference) {
    AnimatedGltf file = probe({{"scale", {2, 3, 4}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
    file.add_channel(node_target(0, "translation"), kTimes, "VEC3", rows(3, -5, 5), GetParam());
    expect_truth(file, kLooks);
}

TEST_P(Modes, ScaleAgreesWithTheReference) {
    AnimatedGltf file = probe({{"translation", {1, 2, 3}}, {"rotation", {0.1, -0.5, 0.5, 0.7}}});
    std::vector<float> values = rows(3, 1, 3);
    if (values.size() == 12) values[4] = -1;  // a mirror at one key
    file.add_channel(node_target(0, "scale"), kTimes, "VEC3", values, GetParam());
    expect_truth(file, kLooks);
}

TEST_P(Modes, RotationAgreesWithTheReference) {
    AnimatedGltf file = probe({{"scale", {2, 3, 0.5}}});
    std::vector<float> values = rows(4, -1, 1);
    const size_t step = values.size() / kTimes.size(), first = step == 4 ? 0 : 4;
    for (size_t key = first; key < values.size(); key += step) {
        const Quaternion q = unit({values[key], values[key + 1], values[key + 2], values[key + 3]});
        for (size_t k = 0; k < 4; ++k) values[key + k] = float(q[k]);
    }
    file.add_channel(node_target(0, "rotation"), kTimes, "VEC4", values, GetParam());
    expect_truth(file, kLooks);
}

TEST_P(Modes, WeightsAgreeWithTheReference) {
    AnimatedGltf file;
    const int moves[] = {file.add_positions({1, 2, 3, 0, 0, 1, 0, 1, 0, 2, 0, 0}),
                         file.add_positions({0, 0, 1, -1, 0, 0, 0, 0, 2, 0, 3, 0}),
                         file.add_positions({0, 4, 0, 0, 0, 0, 1, 1, 1, 0, 0, -2})};
    const int mesh = file.add_probe();
    for (const int move : moves)
        file.json["meshes"][mesh]["primitives"][0]["targets"].push_back({{"POSITION", move}});
    file.json["meshes"][mesh]["weights"] = {0.25, 0.5, 0.75};
    file.add_root({{"mesh", mesh}});
    file.add_channel(node_target(0, "weights"), kTimes, "SCALAR", rows(3, -0.5f, 1.5f), GetParam());
    expect_truth(file, kLooks, 8);
}

INSTANTIATE_TEST_SUITE_P(All, Modes, testing::Values("STEP", "LINEAR", "CUBICSPLINE"));

TEST(AnimationKeys, EqualKeysStandStill) {
    AnimatedGltf file = probe();
    const std::vector<float> q = {0.5f, -0.5f, 0.5f, 0.5f};
    std::vector<float> keys = q;
    keys.insert(keys.end(), q.begin(), q.end());
    for (const float x : q) keys.push_back(-x);
    file.add_channel(node_target(0, "rotation"), {0, 1, 2}, "VEC4", keys);
    const V3f still = vertex(file, 0, 1);
    for (const double time : {0.3, 1., 1.5, 2.})
        EXPECT_LE((vertex(file, time, 1) - still).length(), 1e-7f) << time;
}

TEST(AnimationKeys, KeysOfOtherLengthsTurnAsUnitOnes) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "rotation"), {0, 3, 4}, "VEC4",
                     {0, 0, 0, 4, 0, 0, 1, 1, 0, 0, 0, 0.1f});
    const V3f third = vertex(file, 1, 1);
    EXPECT_NEAR(third.x, std::sqrt(0.75), 1e-7);
    EXPECT_NEAR(third.y, 0.5, 1e-7);
    expect_truth(file, {0, 1.7, 3, 3.2, 3.9});
}

TEST(AnimationKeys, AKeyOfNoLengthTurnsNothing) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "rotation"), {0, 1, 2}, "VEC4",
                     {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0});
    EXPECT_EQ(vertex(file, 0.5, 1), V3f(1, 0, 0));
    const V3f p = vertex(file, 1.5, 1);  // towards a half turn from nowhere
    EXPECT_NEAR(p.length(), 1, 1e-6);
}

TEST(AnimationKeys, RotationsComeOutWithALengthOfOne) {
    io::Keyframes keys;
    keys.times_s = {0, 1};
    keys.width = 4;
    keys.rotation = true;
    keys.interpolation = io::Interpolation::CubicSpline;
    keys.values = {0, 0, 0, 0, 0, 0, 0, 1, 1, 2, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    for (const double time : {-1., 0., 0.3, 0.5, 1., 2.}) {
        const std::vector<double> q = keys.at(time);
        EXPECT_NEAR(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])), 1, 1e-15) << time;
    }
}

TEST(AnimationKeys, HalfATurnIsTurned) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "rotation"), {0, 1}, "VEC4", {0, 0, 0, 1, 0, 1, 0, 0});
    const V3f quarter = vertex(file, 0.5, 1);
    EXPECT_NEAR(quarter.x, 0, 1e-7);
    EXPECT_NEAR(std::fabs(quarter.z), 1, 1e-7);
    expect_truth(file, {0.1, 0.5, 0.99});
}

TEST(AnimationKeys, ATinyTurnIsNotLost) {
    AnimatedGltf file = probe({{"scale", {1e6, 1e6, 1e6}}});
    file.add_channel(node_target(0, "rotation"), {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 1e-6f, 1});
    EXPECT_NEAR(vertex(file, 0.5, 1).y, 1, 1e-6);
}

TEST(AnimationKeys, ASingleKeyHoldsForAllTimes) {
    for (const char* mode : {"STEP", "LINEAR"}) {
        AnimatedGltf file = probe();
        file.add_channel(node_target(0, "translation"), {2}, "VEC3", {1, 2, 3}, mode);
        for (const double time : {-3., 0., 2., 5.}) EXPECT_EQ(vertex(file, time, 0), V3f(1, 2, 3));
    }
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {0}, "VEC3", {7, 7, 7, 1, 2, 3, 8, 8, 8},
                     "CUBICSPLINE");
    EXPECT_EQ(vertex(file, 4, 0), V3f(1, 2, 3));
}

TEST(AnimationKeys, AtEqualTimesTheValueJumps) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {0, 1, 1, 2}, "VEC3",
                     {0, 0, 0, 2, 0, 0, 10, 0, 0, 20, 0, 0});
    EXPECT_EQ(vertex(file, 0.5, 0).x, 1);
    EXPECT_NEAR(vertex(file, 1 - 1e-9, 0).x, 2, 1e-6);
    EXPECT_EQ(vertex(file, 1, 0).x, 10);
    EXPECT_EQ(vertex(file, 1.5, 0).x, 15);
}

TEST(AnimationKeys, ValuesStayBeforeTheFirstKeyAndAfterTheLastOfTheirChannel) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {1, 2}, "VEC3", {3, 0, 0, 5, 0, 0});
    file.add_channel(node_target(0, "scale"), {0, 4}, "VEC3", {1, 1, 1, 2, 2, 2});
    EXPECT_EQ(vertex(file, 0.5, 0).x, 3);
    EXPECT_EQ(vertex(file, 3, 0).x, 5);
    EXPECT_EQ(vertex(file, 3.999999, 0).x, 5);
}

TEST(AnimationKeys, IntegersAreSharesOfOne) {
    AnimatedGltf file = probe();
    file.add_channel<int8_t>(node_target(0, "rotation"), {0, 1, 2}, "VEC4",
                             {0, 0, 0, 127, 90, 0, 0, 90, 0, -90, 0, -90});
    expect_truth(file, {0, 0.3, 1, 1.4, 1.9});
    AnimatedGltf finer = probe();
    finer.add_channel<int16_t>(node_target(0, "rotation"), {0, 1, 2}, "VEC4",
                               {0, 0, 0, 32767, 16384, -16384, 16384, 16384, -32768, 0, 0, 0});
    expect_truth(finer, {0, 0.3, 1, 1.4, 1.9});
    AnimatedGltf positive = probe();
    positive.add_channel<uint16_t>(node_target(0, "rotation"), {0, 1}, "VEC4",
                                   {0, 0, 0, 65535, 0, 39321, 0, 52428});
    expect_truth(positive, {0, 0.25, 0.75});
    AnimatedGltf coarse = probe();
    coarse.add_channel<uint8_t>(node_target(0, "rotation"), {0, 1}, "VEC4",
                                {0, 0, 0, 255, 0, 153, 0, 204});
    expect_truth(coarse, {0, 0.25, 0.75});
}

template <class T>
void expect_weights_of(T full, T part, double share) {
    AnimatedGltf file;
    const int move = file.add_positions({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0});
    file.add_root({{"mesh", file.add_probe({{"targets", {{{"POSITION", move}}}}})}});
    file.add_channel<T>(node_target(0, "weights"), {0, 1}, "SCALAR", {part, full}, "STEP");
    const V3f p = vertex(file, 0.5, 1);
    EXPECT_FLOAT_EQ(p.x, float(1 + share));
    EXPECT_EQ(vertex(file, 1e-9 - 1, 1), p);
}

TEST(AnimationKeys, WeightsMayBeIntegers) {
    expect_weights_of<uint8_t>(255, 51, 0.2);
    expect_weights_of<uint16_t>(65535, 13107, 0.2);
    expect_weights_of<int8_t>(127, -128, -1);
    expect_weights_of<int16_t>(32767, -32768, -1);
}

TEST(AnimationKeys, SparseValuesReplaceOthers) {
    AnimatedGltf file = probe();
    file.add_channel(node_target(0, "translation"), {0, 1, 2}, "VEC3", {1, 1, 1, 2, 2, 2, 3, 3, 3});
    const int indices = file.add_view_of<uint16_t>({1}),
              values = file.add_view_of<float>({5, 6, 7});
    const int output = file.json["animations"][0]["samplers"][0]["output"];
    file.json["accessors"][output]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(vertex(file, 1, 0), V3f(5, 6, 7));
    expect_truth(file, {0, 0.5, 1, 1.5});
    file.json["accessors"][output].erase("bufferView");  // zeros where nothing replaces them
    EXPECT_EQ(vertex(file, 1.5, 0), V3f(2.5f, 3, 3.5f));
    expect_truth(file, {0, 0.5, 1, 1.5});
}

TEST(AnimationKeys, ChannelsOfANodeAndOfItsParentsAddUp) {
    AnimatedGltf file;
    file.add("nodes", {{"children", {1}}, {"translation", {1, 0, 0}}});
    file.add("nodes", {{"children", {2}}, {"scale", {1, 2, 1}}});
    file.add("nodes", {{"mesh", file.add_probe()}, {"rotation", {0, 0.6, 0, 0.8}}});
    file.json["scenes"] = {{{"nodes", {0}}}};
    file.add_channel(node_target(0, "rotation"), {0, 2}, "VEC4", {0, 0, 0, 1, 0.6f, 0, 0, 0.8f});
    file.add_channel(node_target(1, "translation"), {0, 1}, "VEC3", {0, 3, 0, 5, 0, 1}, "STEP");
    file.add_channel(node_target(1, "scale"), {0.5f, 1.5f}, "VEC3", {1, 1, 1, 2, -3, 4});
    file.add_channel(node_target(2, "translation"), {0, 2}, "VEC3",
                     {0, 0, 0, 0, 1, 0, 1, 2, 3, 4, 5, 6, 0, 0, 2, 0, 0, 0}, "CUBICSPLINE");
    file.add_channel(node_target(2, "rotation"), {0, 2}, "VEC4", {0, 1, 0, 0, 0, 0, 0.6f, 0.8f});
    expect_truth(file, {0, 0.2, 0.7, 0.9, 1, 1.3, 1.6, 1.99}, 4);
}

}  // namespace
}  // namespace petzval::test
