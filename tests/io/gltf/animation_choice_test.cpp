// SPDX-License-Identifier: Apache-2.0
// Which animations of a file are played, and how they go on after their end.
#include <gtest/gtest.h>

#include "tests/support/animation/animated_gltf.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::test {
namespace {

using nlohmann::json;

/// Adds an animation that moves a node from 0 along one axis, a metre a second.
void add_motion(AnimatedGltf& file, const char* name, int node, int axis, float seconds) {
    file.add_animation(name);
    std::vector<float> values(6);
    values[size_t(3 + axis)] = seconds;
    file.add_channel(node_target(node, "translation"), {0, seconds}, "VEC3", values);
}

/// Two probes. "along" moves the first one along x, "up" the first one along y, "deep" the second
/// one along z, the last animation has no name.
AnimatedGltf motions() {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}});
    file.add_root({{"mesh", file.add_probe()}});
    add_motion(file, "along", 0, 0, 2);
    add_motion(file, "up", 0, 1, 3);
    add_motion(file, "deep", 1, 2, 4);
    file.add_animation();
    file.add_channel(node_target(1, "scale"), {0, 4}, "VEC3", {1, 1, 1, 5, 5, 5});
    return file;
}

/// Where the origin of a probe is.
V3f origin(const io::GltfFile& file, size_t number) {
    return file.scene.meshes.at(number).positions.at(0);
}

V3f origin(const TinyGltf& file, size_t number, const io::AnimationChoice& choice) {
    return origin(load_at(file, choice), number);
}

TEST(AnimationChoice, AllArePlayedThatDoNotMoveTheSame) {
    const io::GltfFile loaded = load_at(motions(), 1);
    EXPECT_EQ(origin(loaded, 0), V3f(1, 0, 0));
    EXPECT_EQ(origin(loaded, 1), V3f(0, 0, 1));
    EXPECT_EQ(loaded.scene.meshes.at(1).positions.at(1).x, 2);  // scaled by the last animation
    EXPECT_TRUE(contains_line(loaded.remarks, "animation: along at 1 s of 2"));
    EXPECT_TRUE(contains_line(loaded.remarks, "animation: deep at 1 s of 4"));
    EXPECT_TRUE(contains_line(loaded.remarks, "1 more animation is not played"));
}

TEST(AnimationChoice, AnAnimationThatMeetsNoOtherThatIsPlayedIsPlayed) {
    AnimatedGltf file = motions();
    file.add_animation("late");  // moves what only "up", which is not played, moves too
    file.add_channel(node_target(0, "scale"), {0, 2}, "VEC3", {1, 1, 1, 3, 3, 3});
    file.json["animations"][1]["channels"].push_back(
        {{"sampler", 0}, {"target", node_target(0, "scale")}});
    const io::GltfFile loaded = load_at(file, 1);
    EXPECT_EQ(loaded.scene.meshes.at(0).positions.at(1), V3f(3, 0, 0));
}

TEST(AnimationChoice, APointerAndAPathMayMoveTheSame) {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}});
    add_motion(file, "path", 0, 0, 2);
    file.add_animation("pointer");
    file.add_channel(pointer_target("/nodes/0/translation"), {0, 2}, "VEC3", {0, 0, 0, 0, 2, 0});
    EXPECT_EQ(origin(file, 0, moment(1)), V3f(1, 0, 0));
    EXPECT_EQ(origin(file, 0, moment(1, {"pointer"})), V3f(0, 1, 0));
}

TEST(AnimationChoice, ByNameAndNumber) {
    EXPECT_EQ(origin(motions(), 0, moment(1, {"up"})), V3f(0, 1, 0));
    EXPECT_EQ(origin(motions(), 0, moment(1, {"1"})), V3f(0, 1, 0));
    EXPECT_EQ(origin(motions(), 1, moment(1, {"up"})), V3f(0));
    const io::GltfFile both = load_at(motions(), moment(1, {"deep", "1", "deep"}));
    EXPECT_EQ(origin(both, 0), V3f(0, 1, 0));
    EXPECT_EQ(origin(both, 1), V3f(0, 0, 1));
    EXPECT_EQ(std::count_if(both.remarks.begin(), both.remarks.end(),
                            [](const auto& line) { return line.find("deep") != line.npos; }),
              1);
}

TEST(AnimationChoice, WhatTwoNamedOnesMoveTheLaterNameDecides) {
    EXPECT_EQ(origin(motions(), 0, moment(1, {"along", "up"})), V3f(0, 1, 0));
    EXPECT_EQ(origin(motions(), 0, moment(1, {"up", "along"})), V3f(1, 0, 0));
}

TEST(AnimationChoice, WithoutOneTheStoredPoseIsShown) {
    AnimatedGltf file = motions();
    file.json["nodes"][0]["translation"] = {9, 9, 9};
    const io::GltfFile loaded = load(file);
    EXPECT_EQ(origin(loaded, 0), V3f(9));
    EXPECT_TRUE(contains_line(loaded.remarks, "the file holds 4 animations; the pose that it"));
}

TEST(AnimationChoice, AnUnknownNameIsRefused) {
    EXPECT_THROW((void)load_at(motions(), moment(1, {"run"})), io::ArgumentError);
    EXPECT_THROW((void)load_at(motions(), moment(1, {"4"})), io::ArgumentError);
    EXPECT_THROW((void)load_at(motions(), moment(1, {"along", "x"})), io::ArgumentError);
    const std::string text = refusal([] { (void)load_at(motions(), moment(1, {"run"})); });
    EXPECT_TRUE(has(text, "along"));
    EXPECT_TRUE(has(text, "deep"));
}

TEST(AnimationChoice, AFileWithoutAnimationsShowsItsPoseAtAnyTime) {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}, {"translation", {1, 2, 3}}});
    const io::GltfFile loaded = load_at(file, 1);
    EXPECT_EQ(origin(loaded, 0), V3f(1, 2, 3));
    EXPECT_TRUE(contains_line(loaded.remarks, "holds no animation"));
    EXPECT_THROW((void)load_at(file, moment(1, {"run"})), io::ArgumentError);
}

TEST(AnimationLoop, BeginsAnewAfterItsEnd) {
    const AnimatedGltf file = motions();  // "along" takes 2 s
    for (const auto& [time, x] : {std::pair{0., 0.},
                                  {1.5, 1.5},
                                  {2., 0.},
                                  {2.5, 0.5},
                                  {7.25, 1.25},
                                  {-0.5, 1.5},
                                  {-2., 0.},
                                  {-3.75, 0.25},
                                  {1e6 + 0.5, 0.5}})
        EXPECT_FLOAT_EQ(origin(file, 0, moment(time)).x, float(x)) << time;
}

TEST(AnimationLoop, EachRepeatsByItsOwnLength) {
    const io::GltfFile loaded = load_at(motions(), 5.5);
    EXPECT_FLOAT_EQ(origin(loaded, 0).x, 1.5f);  // of 2 s
    EXPECT_FLOAT_EQ(origin(loaded, 1).z, 1.5f);  // of 4 s
}

TEST(AnimationLoop, LastsAsLongAsItsLastKeyOfAll) {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}});
    add_motion(file, "", 0, 0, 2);
    file.add_channel(node_target(0, "scale"), {0, 5}, "VEC3", {1, 1, 1, 1, 1, 1});
    EXPECT_EQ(origin(file, 0, moment(3)).x, 2);
    EXPECT_EQ(origin(file, 0, moment(6)).x, 1);
}

TEST(AnimationLoop, StartsAtZeroWhateverTheFirstKey) {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}});
    file.add_channel(node_target(0, "translation"), {1, 3}, "VEC3", {1, 0, 0, 3, 0, 0});
    EXPECT_EQ(origin(file, 0, moment(0.5)).x, 1);
    EXPECT_EQ(origin(file, 0, moment(3.5)).x, 1);  // half a second of the second turn
    EXPECT_EQ(origin(file, 0, moment(5)).x, 2);
}

/// Where the first probe is along x at a time, as without --loop and with it.
std::array<float, 2> along(const AnimatedGltf& file, double time_s) {
    return {origin(file, 0, {time_s, {}, false}).x, origin(file, 0, {time_s, {}, true}).x};
}

TEST(AnimationEnd, ItsLastMomentIsItsLastPose) {
    for (const float seconds : {1.f, 2.f, 0.1f, 0.3f, 25.f / 24}) {
        AnimatedGltf file;
        file.add_root({{"mesh", file.add_probe()}});
        add_motion(file, "", 0, 0, seconds);
        // As decimals of the command line and frames have it, and as the float of the key.
        for (const double end : {std::round(double(seconds) * 240) / 240, double(seconds)}) {
            EXPECT_NEAR(along(file, end)[0], seconds, 1e-6) << seconds;
            EXPECT_NEAR(along(file, end)[1], 0, 1e-6) << seconds;  // begins anew
            EXPECT_NEAR(along(file, -end)[0], 0, 1e-6) << seconds;
            EXPECT_NEAR(along(file, -end)[1], 0, 1e-6) << seconds;
            EXPECT_NEAR(along(file, 3 * end)[1], 0, 1e-6) << seconds;
            EXPECT_NEAR(along(file, 0.99 * end)[1], 0.99 * double(seconds), 1e-6) << seconds;
        }
    }
}

TEST(AnimationEnd, EachEndsWhereItEnds) {
    const io::GltfFile loaded = load_at(motions(), io::AnimationChoice{3, {}});
    EXPECT_EQ(origin(loaded, 0).x, 2);  // of 2 s
    EXPECT_EQ(origin(loaded, 1).z, 3);  // of 4 s
}

TEST(AnimationEnd, AnArmatureOfBlenderEndsAsItEnds) {
    const std::filesystem::path path = PETZVAL_SHARED "/faults2/blender/armature.glb";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs the folder ../shared";
    const auto at_frame = [&](int frame) {
        const io::GltfFile file = load_at(path, io::AnimationChoice{frame / 24., {}});
        std::vector<V3f> all;
        for (const Mesh& mesh : file.scene.meshes)
            all.insert(all.end(), mesh.positions.begin(), mesh.positions.end());
        return all;
    };
    const auto apart_by = [](const std::vector<V3f>& a, const std::vector<V3f>& b) {
        float most = 0;
        for (size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).length());
        return most;
    };
    const auto first = at_frame(1), before = at_frame(24), last = at_frame(25);
    ASSERT_EQ(first.size(), last.size());
    EXPECT_GT(apart_by(first, last), 0.5f);
    EXPECT_LT(apart_by(before, last), apart_by(first, last) / 8);
    EXPECT_EQ(apart_by(at_frame(40), last), 0);
}

TEST(AnimationLoop, MayStayAsItEnds) {
    for (const auto& [time, x] :
         {std::pair{1.5, 1.5}, {2., 2.}, {2.5, 2.}, {1e6, 2.}, {-0.5, 0.}, {-1e6, 0.}})
        EXPECT_FLOAT_EQ(origin(motions(), 0, {time, {}, false}).x, float(x)) << time;
}

TEST(AnimationLoop, AClosedOneGoesOn) {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}});
    file.add_channel(node_target(0, "translation"), {0, 1, 2}, "VEC3", {0, 0, 0, 4, 0, 0, 0, 0, 0});
    for (const auto& [time, x] : {std::pair{0.5, 2.}, {2., 0.}, {2.5, 2.}, {3.5, 2.}, {-0.25, 1.}})
        EXPECT_FLOAT_EQ(origin(file, 0, moment(time)).x, float(x)) << time;
}

/// What a moment sees that is not the one by which turns are counted, as an open shutter has it.
TEST(AnimationLoop, AnExposureAcrossTheEndStaysThereUnlessTheMotionIsClosed) {
    io::GltfClip clip;
    clip.duration_s = 2;
    EXPECT_EQ(clip.local_s(2.25, 1.75, true), 2);
    EXPECT_EQ(clip.local_s(1.75, 2.25, true), 0);
    EXPECT_EQ(clip.local_s(4.5, 4.25, true), 0.5);
    clip.closed = true;
    EXPECT_EQ(clip.local_s(2.25, 1.75, true), 0.25);
    EXPECT_EQ(clip.local_s(1.75, 2.25, true), 1.75);
    EXPECT_EQ(clip.local_s(2.25, 1.75, false), 2);
    clip.duration_s = 0;
    EXPECT_EQ(clip.local_s(2.25, 1.75, true), 0);
}

/// Whether a clip of one property with these keys is closed.
bool closes(size_t width, bool rotation, const std::vector<double>& values) {
    io::GltfClip clip;
    io::Keyframes keys;
    keys.width = width;
    keys.rotation = rotation;
    keys.values = values;
    for (size_t i = 0; i < values.size() / width; ++i) keys.times_s.push_back(double(i));
    clip.duration_s = keys.times_s.back();
    clip.properties.push_back({"/nodes/0/x", keys});
    clip.find_whether_closed();
    return clip.closed;
}

TEST(AnimationLoop, IsClosedWhereItEndsAsItBegins) {
    EXPECT_TRUE(closes(1, false, {3, 4, 3}));
    EXPECT_TRUE(closes(1, false, {3, 1003, 3.5}));
    EXPECT_FALSE(closes(1, false, {3, 4, 3.5}));
    EXPECT_FALSE(closes(1, false, {3, 4}));
    EXPECT_TRUE(closes(1, false, {3, 3}));
    EXPECT_FALSE(closes(2, false, {3, 3, 4, 4, 3, 4}));
    EXPECT_TRUE(closes(4, true, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, -1}));  // a whole turn
    EXPECT_FALSE(closes(4, true, {0, 0, 0, 1, 0, 0, 1, 0}));
    EXPECT_FALSE(closes(4, false, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, -1}));
}

}  // namespace
}  // namespace petzval::test
