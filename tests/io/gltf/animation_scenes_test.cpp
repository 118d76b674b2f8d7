// SPDX-License-Identifier: Apache-2.0
// Animated models of others: every vertex is where the reference says at eight times.
#include <gtest/gtest.h>

#include "io/base/error.h"
#include "tests/support/animation/animated_gltf.h"

namespace petzval::test {
namespace {

const std::filesystem::path kOpenScenes = PETZVAL_SHARED "/scenes/open";

struct Moving {
    std::string file;
    size_t animations;
    double steps;  ///< of a float at the greatest coordinate, as expect_shapes() has them
};

class MovingScene : public testing::TestWithParam<Moving> {};

TEST_P(MovingScene, StandsWhereTheReferenceSays) {
    const auto path = kOpenScenes / GetParam().file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    const io::GltfSource source = io::read_gltf_source(path);
    ASSERT_EQ(source.json.value("animations", nlohmann::json::array()).size(),
              GetParam().animations);
    constexpr int kMoments = 8;
    for (size_t number = 0; number < GetParam().animations; ++number) {
        double end = 0;
        const AnimationTruth still(source.json, source.buffers);
        for (const auto& sampler : source.json["animations"][number]["samplers"])
            end = std::max(end, still.numbers(sampler["input"]).back());
        for (int i = 0; i < kMoments; ++i) {
            const double time = end * (i + 0.37) / kMoments;
            SCOPED_TRACE(testing::Message() << "animation " << number << " at " << time);
            AnimationTruth truth = still;
            truth.play(number, time);
            const io::GltfFile loaded = load_at(path, moment(time, {std::to_string(number)}));
            expect_shapes(truth.shapes(), loaded, GetParam().steps);
        }
    }
    if (GetParam().animations == 0)  // at any time it stands as it is stored
        expect_shapes(AnimationTruth(source.json, source.buffers).shapes(),
                      load_at(path, moment(1)), GetParam().steps);
}

std::vector<Moving> moving_scene() {
    std::vector<Moving> out = {{"fox/Fox.glb", 3, 2},
                               {"two-cylinder-engine/2CylinderEngine.glb", 0, 2},
                               // Eight targets are added up in floats.
                               {"morph-stress/morph-stress-test.glb", 3, 16}};
    for (int i = 0; i < 6; ++i)
        out.push_back(
            {"asset-generator/Animation_Node/Animation_Node_0" + std::to_string(i) + ".gltf", 1,
             2});
    for (const char* number : {"01", "04", "07", "09"})
        out.push_back(
            {std::string("asset-generator/Animation_Skin/Animation_Skin_") + number + ".gltf", 1,
             2});
    return out;
}

/// A moment makes the loader check and mend the file's JSON once more.
TEST(StillScene, IsAtAnyTimeAsItIsStored) {
    if (!std::filesystem::exists(kOpenScenes)) GTEST_SKIP() << kOpenScenes << " is not here";
    constexpr uint64_t kMostBytes = 4 << 20;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kOpenScenes)) {
        const auto& path = entry.path();
        if (path.extension() != ".gltf" && path.extension() != ".glb") continue;
        if (path.string().find("/bad/") != std::string::npos || entry.file_size() > kMostBytes)
            continue;
        SCOPED_TRACE(path);
        io::GltfFile stored;
        try {
            stored = io::load_gltf(path);
        } catch (const io::InputError&) {
            continue;  // some are there to be refused
        }
        if (stored.holds.animation_count > 0) continue;
        const io::GltfFile later = load_at(path, moment(1.5));
        EXPECT_EQ(later.warnings, stored.warnings);
        EXPECT_EQ(later.cameras.size(), stored.cameras.size());
        EXPECT_EQ(later.scene.lights.size(), stored.scene.lights.size());
        EXPECT_EQ(later.scene.materials.size(), stored.scene.materials.size());
        ASSERT_EQ(later.scene.instances.size(), stored.scene.instances.size());
        ASSERT_EQ(later.scene.meshes.size(), stored.scene.meshes.size());
        for (size_t i = 0; i < stored.scene.meshes.size(); ++i)
            EXPECT_EQ(later.scene.meshes[i].positions, stored.scene.meshes[i].positions);
    }
}

INSTANTIATE_TEST_SUITE_P(Open, MovingScene, testing::ValuesIn(moving_scene()), [](const auto& one) {
    std::string name = std::filesystem::path(one.param.file).stem();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
});

}  // namespace
}  // namespace petzval::test
