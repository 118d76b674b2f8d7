// SPDX-License-Identifier: Apache-2.0
// Animations that are wrong. What a channel with a fault moves stays, with a warning that names the
// place; an animation that is none is refused where it is played. Of others there is a warning,
// and petzval info names every fault.
#include <gtest/gtest.h>

#include "tests/support/animation/animated_gltf.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_png.h"

namespace petzval::test {
namespace {

using nlohmann::json;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// A probe that an animation moves along x, and one that does nothing.
AnimatedGltf moving(const std::vector<float>& times = {0, 1, 2},
                    const std::vector<float>& values = {0, 0, 0, 1, 0, 0, 2, 0, 0}) {
    AnimatedGltf file;
    file.add_root({{"mesh", file.add_probe()}});
    file.add_animation("wrong");
    file.add_channel(node_target(0, "translation"), times, "VEC3", values);
    file.json["animations"].push_back(
        {{"name", "idle"}, {"samplers", json::array()}, {"channels", json::array()}});
    return file;
}

json& sampler_of(TinyGltf& file) {
    return file.json["animations"][0]["samplers"][0];
}
json& channel_of(TinyGltf& file) {
    return file.json["animations"][0]["channels"][0];
}

std::string why_refused(const TinyGltf& file) {
    return refusal([&] { (void)load_at(file, moment(0.5, {"wrong"})); });
}

/// The warnings of a file whose one channel is left out: the probe stays where it is.
std::string left_out(const TinyGltf& file) {
    const io::GltfFile loaded = load_at(file, moment(0.5, {"wrong"}));
    EXPECT_EQ(loaded.scene.meshes.at(0).positions.at(0), V3f(0));
    std::string text;
    for (const std::string& line : loaded.warnings) text += line + "\n";
    EXPECT_TRUE(has(text, "; /animations/0/channels/0 is left out"));
    EXPECT_TRUE(has("\n" + text, "\n/animations/0/"));
    return text;
}

/// Warnings of what petzval info looks through.
std::vector<std::string> told(const TinyGltf& file) {
    const TempFolder folder;
    io::GltfChoices choices;
    choices.checks_all_animations = true;
    io::PictureBudget pictures;
    return io::load_gltf(file.save_glb(folder.path / "test.glb"), io::FileScope::Anywhere, pictures,
                         choices)
        .warnings;
}

/// Where the probe's origin is at half a second.
V3f shown(const TinyGltf& file) {
    return load_at(file, moment(0.5, {"wrong"})).scene.meshes.at(0).positions.at(0);
}

TEST(AnimationRefusal, NothingIsWrongWithTheOthers) {
    EXPECT_EQ(shown(moving()), V3f(0.5f, 0, 0));
    EXPECT_TRUE(load_at(moving(), 0.5).warnings.empty());
}

TEST(AnimationRefusal, TimesMustBeInOrderAndFrom0) {
    const std::string at = "/animations/0/samplers/0/input: ";
    EXPECT_TRUE(has(left_out(moving({0, 2, 1})), at + "key 2 is before key 1"));
    EXPECT_TRUE(has(left_out(moving({-1, 0, 1})), at + "the time of key 0 is not a number from 0"));
    EXPECT_TRUE(has(left_out(moving({0, kNan, 1})), at + "the time of key 1"));
    EXPECT_TRUE(has(left_out(moving({0, 1, kInf})), at + "the time of key 2"));
}

TEST(AnimationRefusal, ThereMustBeKeys) {
    AnimatedGltf file = moving();
    file.json["accessors"][sampler_of(file)["input"].get<size_t>()]["count"] = 0;
    EXPECT_TRUE(has(why_refused(file), "/count: must be at least 1"));
    EXPECT_TRUE(contains_line(told(file), "/animations/0/channels/0 is left out"));
}

TEST(AnimationRefusal, ValuesMustBeFinite) {
    const std::string at = "/animations/0/samplers/0/output: number ";
    EXPECT_TRUE(has(left_out(moving({0, 1, 2}, {0, 0, 0, 0, kNan, 0, 0, 0, 0})), at + "4 is not"));
    EXPECT_TRUE(has(left_out(moving({0, 1, 2}, {0, 0, 0, 0, 0, 0, 0, 0, -kInf})), at + "8 is not"));
}

TEST(AnimationRefusal, ThereMustBeValuesForAllKeys) {
    const std::string at = "/animations/0/samplers/0/output: ";
    EXPECT_TRUE(has(left_out(moving({0, 1, 2, 3})), at + "holds 9 numbers; 4 keys need 12"));
    AnimatedGltf file = moving();
    sampler_of(file)["interpolation"] = "CUBICSPLINE";
    EXPECT_TRUE(has(left_out(file), at + "holds 9 numbers; 3 keys need 27"));
}

TEST(AnimationRefusal, TooFewWeightsAreNotMixedUp) {
    AnimatedGltf file = moving();
    const int up = file.add_positions({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0});
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", up}}};
    channel_of(file)["target"]["path"] = "weights";
    sampler_of(file)["output"] = file.add_accessor<float>("SCALAR", {1, 2, 3, 4, 5});
    EXPECT_TRUE(
        has(left_out(file), "/animations/0/samplers/0/output: holds 5 numbers; 3 keys need 6"));
    sampler_of(file)["output"] = file.add_accessor<float>("VEC2", {1, 2, 3, 4, 5, 6});
    EXPECT_EQ(shown(file), V3f(0, 5, 0));
}

TEST(AnimationRefusal, ValuesLeftOverAreToldOf) {
    const AnimatedGltf file = moving({0, 2});
    EXPECT_EQ(shown(file), V3f(0.25f, 0, 0));
    EXPECT_TRUE(contains_line(load_at(file, 0.5).warnings,
                              "/animations/0/samplers/0: holds 9 numbers in output, but 2 keys "
                              "need 6"));
}

TEST(AnimationRefusal, ValuesMustBeOfTheWidthOfWhatTheyMove) {
    AnimatedGltf file = moving();
    sampler_of(file)["output"] = file.add_accessor<float>("VEC4", std::vector<float>(12));
    EXPECT_TRUE(has(left_out(file),
                    "/animations/0/samplers/0/output: is an accessor of VEC4, not of "
                    "3 numbers"));
    channel_of(file)["target"]["path"] = "rotation";
    EXPECT_EQ(shown(file), V3f(0));
    sampler_of(file)["output"] = file.add_accessor<float>("VEC3", std::vector<float>(12));
    EXPECT_TRUE(has(left_out(file), "is an accessor of VEC3, not of 4 numbers"));
}

TEST(AnimationRefusal, KeysMustBeScalarsAndThere) {
    AnimatedGltf file = moving();
    sampler_of(file)["input"] = file.add_accessor<float>("VEC2", std::vector<float>(6));
    EXPECT_TRUE(
        has(left_out(file), "/animations/0/samplers/0/input: must be an accessor of SCALAR"));
    sampler_of(file)["input"] = 99;
    EXPECT_TRUE(has(left_out(file), "/animations/0/samplers/0/input: "));
    sampler_of(file).erase("input");
    EXPECT_TRUE(has(left_out(file), "/animations/0/samplers/0"));
    file = moving();
    sampler_of(file).erase("output");
    EXPECT_TRUE(has(left_out(file), "/animations/0/samplers/0"));
}

TEST(AnimationRefusal, AnUnknownInterpolationIsLeftOut) {
    AnimatedGltf file = moving();
    sampler_of(file)["interpolation"] = "CATMULLROMSPLINE";
    EXPECT_TRUE(has(left_out(file), "/animations/0/samplers/0/interpolation: is \"CATMULL"));
    sampler_of(file)["interpolation"] = 3;
    EXPECT_TRUE(has(left_out(file), "/animations/0/samplers/0/interpolation: "));
    sampler_of(file)["interpolation"] = "Step";
    EXPECT_EQ(shown(file), V3f(0));
    sampler_of(file).erase("interpolation");
    EXPECT_EQ(shown(file), V3f(0.5f, 0, 0));
}

TEST(AnimationRefusal, ReferencesMustLeadSomewhere) {
    AnimatedGltf file = moving();
    channel_of(file)["sampler"] = 1;
    EXPECT_TRUE(has(left_out(file), "/animations/0/channels/0/sampler: "));
    file = moving();
    channel_of(file)["target"]["node"] = 1;
    EXPECT_TRUE(has(left_out(file), "/animations/0/channels/0/target/node: "));
    file = moving();
    channel_of(file).erase("target");
    EXPECT_TRUE(has(left_out(file), "/animations/0/channels/0"));
    file = moving();
    channel_of(file)["target"].erase("path");
    EXPECT_TRUE(has(left_out(file), "/animations/0/channels/0/target"));
    file = moving();
    channel_of(file)["target"]["path"] = 5;
    EXPECT_TRUE(has(left_out(file), "/animations/0/channels/0/target/path"));
    file = moving();
    file.json["animations"][0].erase("samplers");
    EXPECT_TRUE(has(why_refused(file), "/animations/0"));
    file = moving();
    file.json["animations"][0].erase("channels");
    EXPECT_TRUE(has(why_refused(file), "/animations/0"));
    file = moving();
    file.json["animations"][0]["channels"] = 7;
    EXPECT_TRUE(has(why_refused(file), "/animations/0/channels"));
}

TEST(AnimationRefusal, AnAccessorOfAPlayedAnimationIsCheckedAsOthersAre) {
    AnimatedGltf file = moving();
    file.json["accessors"][sampler_of(file)["output"].get<size_t>()]["count"] = 3000;
    EXPECT_TRUE(has(why_refused(file), "/accessors/"));
    EXPECT_EQ(load_at(file, moment(1, {"idle"})).scene.meshes.size(), 1u);
}

/// A channel more, which moves what `pointer` names with these values.
AnimatedGltf with_channel(const char* pointer, const char* type, const std::vector<float>& values) {
    AnimatedGltf file = moving();
    file.add("materials", {{"normalTexture", {{"index", 0}}}});
    file.add_image(tiny_png(1, 1, {128, 128, 255, 255}));
    file.add("textures", {{"source", 0}});
    json idle = file.json["animations"].back();
    file.json["animations"].erase(1);
    file.add_channel(pointer_target(pointer), {0, 2}, type, values);
    file.json["animations"].push_back(idle);
    return file;
}

TEST(AnimationRefusal, TheOtherChannelsOfAnAnimationArePlayed) {
    const std::pair<AnimatedGltf, const char*> cases[] = {
        {with_channel("/materials/0/normalTexture/offset", "VEC4", {0, 0, 0, 0, 1, 1, 1, 1}),
         "animates /materials/0/normalTexture/offset, which Petzval does not read"},
        {with_channel("/materials/0/normalTexture/offset", "VEC2", {0, 0, 1, 1}),
         "animates /materials/0/normalTexture/offset"},
        {with_channel("/materials/0/normalTexture/scale", "VEC2", {0, 0, 1, 1}),
         "/animations/0/samplers/1/output: is an accessor of VEC2, not of 1 numbers; "
         "/animations/0/channels/1 is left out"},
        {with_channel("/materials/0/normalTexture/scale", "SCALAR", {0}),
         "/animations/0/samplers/1/output: holds 1 numbers; 2 keys need 2; "
         "/animations/0/channels/1 is left out"}};
    for (const auto& [file, part] : cases) {
        EXPECT_EQ(shown(file), V3f(0.5f, 0, 0)) << part;
        EXPECT_TRUE(contains_line(load_at(file, 0.5).warnings, part)) << part;
        // Without a time it is silent, and petzval info tells of it.
        EXPECT_FALSE(contains_line(load(file).warnings, "/animations/")) << part;
        EXPECT_TRUE(contains_line(told(file), part)) << part;
    }
}

TEST(AnimationRefusal, WhatGltfDefinesElsewhereIsNoProperty) {
    for (const char* pointer :
         {"/materials/0/normalTexture/rotation", "/materials/0/scale",
          "/materials/0/clearcoatFactor", "/materials/0/normalTexture/strength",
          "/materials/0/normalTexture/color", "/materials/0/roughnessFactor",
          "/materials/0/normalTexture/translation", "/materials/0/specularFactor"}) {
        const auto file = with_channel(pointer, "VEC4", std::vector<float>(8));
        EXPECT_TRUE(
            contains_line(load_at(file, 0.5).warnings, "/animations/0/channels/1/target: animates"))
            << pointer;
    }
}

TEST(AnimationRefusal, OfOneAmongOthersInfoTells) {
    EXPECT_TRUE(told(moving()).empty());
    EXPECT_TRUE(contains_line(told(moving({0, 2, 1})),
                              "/animations/0/samplers/0/input: key 2 is before key 1"));
    AnimatedGltf file = moving({0, 1, 2}, {0, 0, 0, 0, kNan, 0, 0, 0, 0});
    EXPECT_TRUE(contains_line(told(file), "output: number 4 is not finite"));
    file = moving();
    file.json["animations"][0].erase("samplers");
    EXPECT_TRUE(contains_line(told(file), "/animations/0"));
    file = moving();
    file.json["accessors"][sampler_of(file)["output"].get<size_t>()]["count"] = 3000;
    EXPECT_TRUE(contains_line(told(file), "/animations/0/channels/0 is left out"));
}

TEST(AnimationRefusal, AChannelWithoutANodeIsLeftOut) {
    AnimatedGltf file = moving();
    channel_of(file)["target"].erase("node");
    EXPECT_EQ(shown(file), V3f(0));
}

TEST(AnimationRefusal, WhatIsNoPathOfGltfIsWarnedOf) {
    AnimatedGltf file = moving();
    channel_of(file)["target"]["path"] = "wobble";
    EXPECT_EQ(shown(file), V3f(0));
    EXPECT_TRUE(contains_line(load_at(file, 0.5).warnings,
                              "/animations/0/channels/0/target: animates /nodes/0/wobble"));
}

TEST(AnimationRefusal, ANodeWithAMatrixStays) {
    AnimatedGltf file = moving();
    file.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};
    EXPECT_EQ(shown(file), V3f(7, 8, 9));
    EXPECT_TRUE(contains_line(load_at(file, 0.5).warnings, "animates /nodes/0/translation"));
}

TEST(AnimationRefusal, OfTwoChannelsForOneTargetTheFirstIsTaken) {
    AnimatedGltf file = moving();
    json second = channel_of(file);
    second["sampler"] = 1;
    json other = sampler_of(file);
    other["output"] = file.add_accessor<float>("VEC3", std::vector<float>(9, 8.f));
    file.json["animations"][0]["samplers"].push_back(other);
    file.json["animations"][0]["channels"].push_back(second);
    EXPECT_EQ(shown(file), V3f(0.5f, 0, 0));
    EXPECT_TRUE(contains_line(load_at(file, 0.5).warnings,
                              "/animations/0/channels/1/target: animates what an earlier"));
}

TEST(AnimationRefusal, AnAnimationWithoutChannelsChangesNothing) {
    const io::GltfFile loaded = load_at(moving(), moment(0.5, {"idle"}));
    EXPECT_EQ(loaded.scene.meshes.at(0).positions.at(0), V3f(0));
    EXPECT_TRUE(contains_line(loaded.remarks, "animation: idle at 0 s of 0"));
}

TEST(AnimationRefusal, ANodeThatShrinksToNothingIsNotShown) {
    AnimatedGltf file = moving({0, 1, 2}, {1, 1, 1, 0, 0, 0, -1, -1, -1});
    channel_of(file)["target"]["path"] = "scale";
    EXPECT_TRUE(load_at(file, 1).scene.instances.empty());
    EXPECT_TRUE(contains_line(load_at(file, 1).warnings, "1 node scaled to nothing skipped"));
    expect_truth(file, {0, 0.5, 1.5, 1.9});
}

TEST(AnimationRefusal, ASplineBeyondTheRangeOfAFloatIsRefused) {
    const float most = std::numeric_limits<float>::max();
    AnimatedGltf file = moving({0, 1e6f}, std::vector<float>(18));
    sampler_of(file)["interpolation"] = "CUBICSPLINE";
    std::vector<float> values(18);
    values[6] = most;
    sampler_of(file)["output"] = file.add_accessor<float>("VEC3", values);
    const std::string text = refusal([&] { (void)load_at(file, moment(3e5, {"wrong"})); });
    EXPECT_TRUE(has(text, "/nodes/0/translation"));
}

TEST(AnimationRefusal, ACameraBeyondTheRangeOfAFloatIsRefused) {
    AnimatedGltf file = moving();
    file.add("cameras", {{"type", "orthographic"},
                         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}});
    file.add_root({{"camera", 0}});
    channel_of(file)["target"] = pointer_target("/cameras/0/orthographic/xmag");
    sampler_of(file)["interpolation"] = "CUBICSPLINE";
    sampler_of(file)["input"] = file.add_accessor<float>("SCALAR", {0, 1e6f});
    sampler_of(file)["output"] =
        file.add_accessor<float>("SCALAR", {0, 1, std::numeric_limits<float>::max(), 0, 1, 0});
    const std::string text = refusal([&] { (void)load_at(file, moment(3e5, {"wrong"})); });
    EXPECT_TRUE(has(text, "/cameras/0/orthographic/xmag"));
}

TEST(AnimationRefusal, TimesFarAwayAreTimes) {
    const AnimatedGltf file = moving();
    EXPECT_FLOAT_EQ(load_at(file, 1e6 + 0.5).scene.meshes.at(0).positions.at(0).x, 0.5f);
    EXPECT_FLOAT_EQ(load_at(file, -1e6 + 0.5).scene.meshes.at(0).positions.at(0).x, 0.5f);
    EXPECT_NEAR(load_at(file, 1e6 + 1.98).scene.meshes.at(0).positions.at(0).x, 1.98, 1e-4);
    AnimatedGltf late = moving({1e30f, 2e30f, 3e30f});
    EXPECT_EQ(shown(late), V3f(0));
}

TEST(AnimationRefusal, ABrokenOneThatIsNotPlayedIsAWarning) {
    AnimatedGltf file = moving();
    sampler_of(file)["input"] = 99;
    const io::GltfFile played = load_at(file, moment(0.5, {"idle"}));
    EXPECT_EQ(played.scene.meshes.size(), 1u);
    EXPECT_TRUE(contains_line(played.warnings, "/animations/0: is broken in places"));
    EXPECT_TRUE(contains_line(load(file).warnings, "/animations/0: is broken in places"));
    EXPECT_TRUE(has(left_out(file), "/animations/0/samplers/0/input"));
    EXPECT_TRUE(load_at(moving({0, 2, 1}), moment(0.5, {"idle"})).warnings.empty());
}

TEST(AnimationRefusal, EachReferenceOfOneThatIsNotPlayedIsLookedAt) {
    const std::pair<const char*, json> changes[] = {
        {"/sampler", 1}, {"/target/node", 99}, {"/target/path", 5}, {"/target", 5}};
    for (const auto& [at, value] : changes) {
        AnimatedGltf file = moving();
        channel_of(file)[json::json_pointer(at)] = value;
        EXPECT_TRUE(contains_line(load(file).warnings, "/animations/0: is broken in places")) << at;
    }
}

TEST(AnimationRefusal, ASamplerThatNoChannelUsesMayBeBroken) {
    AnimatedGltf file = moving();
    file.json["animations"][0]["samplers"].push_back({{"input", 99}, {"output", 99}});
    EXPECT_EQ(shown(file), V3f(0.5f, 0, 0));
    EXPECT_TRUE(load_at(file, 0.5).warnings.empty());  // it is played, so it is not broken
    EXPECT_TRUE(contains_line(load(file).warnings, "/animations/0: is broken"));
}

TEST(AnimationRefusal, AListThatIsNoneIsRefused) {
    AnimatedGltf file = moving();
    file.json["animations"] = {{"name", "no list"}};
    EXPECT_TRUE(has(why_refused(file), "/animations"));
    file.json["animations"] = {5};
    EXPECT_TRUE(has(why_refused(file), "/animations/0"));
}

/// Zeros that the file need not hold, at ever more nodes: some kilobytes would ask for gigabytes.
TEST(AnimationRefusal, TheSameValuesAtManyNodesMustNotAskForAllMemory) {
    constexpr size_t kKeys = 1'000'000;
    AnimatedGltf file = moving();
    const int input =
        file.add("accessors", {{"componentType", 5126}, {"type", "SCALAR"}, {"count", kKeys}});
    const int output =
        file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", kKeys}});
    json& animation = file.json["animations"][0];
    animation["samplers"] = {{{"input", input}, {"output", output}}};
    animation["channels"] = json::array();
    for (int i = 0; i < 40; ++i) {
        const int node = file.add("nodes", {{"name", "one of many"}});
        animation["channels"].push_back({{"sampler", 0}, {"target", node_target(node, "scale")}});
    }
    EXPECT_TRUE(has(why_refused(file), "/animations/0/samplers/0: asks for "));
}

}  // namespace
}  // namespace petzval::test
