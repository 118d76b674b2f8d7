// SPDX-License-Identifier: Apache-2.0
// Scenes made by others: all of them load, with the numbers that their makers and lists state.
#include <gtest/gtest.h>

#include <fstream>

#include "io/base/error.h"
#include "tests/support/load_tiny_gltf.h"

namespace petzval::io {
namespace {

const std::filesystem::path kScenesOpen = PETZVAL_SHARED "/scenes/open";

struct Expected {
    const char* file;
    size_t stored, placed;  ///< triangles, those without area left out
    size_t images, lights, cameras;
};

class RealScene : public testing::TestWithParam<Expected> {};

TEST_P(RealScene, Loads) {
    const Expected& expected = GetParam();
    if (!std::filesystem::exists(kScenesOpen / expected.file))
        GTEST_SKIP() << kScenesOpen / expected.file << " is not here";
    const GltfFile loaded = load_gltf(kScenesOpen / expected.file);
    const Scene& scene = loaded.scene;
    size_t stored = 0, placed = 0;
    for (const Mesh& mesh : scene.meshes) stored += mesh.triangles.size();
    for (const Instance& instance : scene.instances)
        placed += scene.meshes.at(instance.mesh).triangles.size();
    EXPECT_EQ(stored, expected.stored);
    EXPECT_EQ(placed, expected.placed);
    EXPECT_EQ(scene.images.size(), expected.images);
    EXPECT_EQ(scene.lights.size(), expected.lights);
    EXPECT_EQ(loaded.cameras.size(), expected.cameras);
    for (const Mesh& mesh : scene.meshes) ASSERT_LT(mesh.material, scene.materials.size());
}

INSTANTIATE_TEST_SUITE_P(
    Open, RealScene,
    testing::Values(Expected{"anatomy-bones/anatomy-bones.glb", 1888664, 1888664, 0, 0, 0},
                    Expected{"cameras/Cameras.gltf", 2, 2, 0, 0, 2},
                    Expected{"cornell-box/CornellBox.glb", 36, 36, 0, 0, 0},
                    Expected{"damaged-helmet/DamagedHelmet.glb", 15452, 15452, 4, 0, 0},
                    Expected{"depth-of-field/DepthOfFieldExample.glb", 10610, 10610, 5, 1, 0},
                    Expected{"diamond/diamond-glass.glb", 96, 96, 0, 0, 0},
                    Expected{"dispersion-test/dispersion-test.glb", 51827, 51827, 2, 0, 0},
                    Expected{"flight-helmet/FlightHelmet.gltf", 94722, 94722, 15, 0, 0},
                    Expected{"fox/Fox.glb", 576, 576, 1, 0, 0},
                    Expected{"grass-field/grass-field.glb", 4256, 1155872, 0, 0, 0},
                    Expected{"hotel-room/hotel-room.glb", 99029, 99029, 6, 0, 0},
                    Expected{"house-foliage/house.glb", 10497, 10497, 1, 0, 0},
                    Expected{"light-culling/lightCulling.gltf", 12, 12, 0, 4, 1},
                    Expected{"lowpoly-village/low-poly.gltf", 4580, 5204, 0, 1, 0},
                    Expected{"many-lights/many-lights.glb", 1042, 200002, 0, 0, 1},
                    Expected{"mixed-lighting/MixedLightingExample.gltf", 40898, 40898, 4, 1, 0},
                    Expected{"morph-stress/morph-stress-test.glb", 2412, 2412, 2, 0, 0},
                    Expected{"shadows-spot/shadows-spot.gltf", 1108, 1108, 0, 1, 1},
                    Expected{"two-cylinder-engine/2CylinderEngine.glb", 65311, 110336, 0, 0, 1}),
    [](const auto& scene) {
        const std::string file = scene.param.file;
        std::string name;
        for (char c : file.substr(0, file.find('/')))
            if (c != '-') name += c;
        return name;
    });

TEST(RealScene, TrianglesWithoutAreaAreCounted) {
    const auto path = kScenesOpen / "two-cylinder-engine/2CylinderEngine.glb";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    EXPECT_TRUE(contains_line(load_gltf(path).warnings, "10419 triangles without area skipped"));
}

TEST(AssetGenerator, FilesLoadOrAreRefusedAsListed) {
    const auto folder = kScenesOpen / "asset-generator";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
    std::ifstream stream(folder / "manifest.json");
    for (const auto& category : nlohmann::json::parse(stream))
        for (const auto& model : category["models"]) {
            const auto path = folder / category["folder"].get<std::string>() /
                              model["fileName"].get<std::string>();
            bool loads = true;
            try {
                (void)load_gltf(path);
            } catch (const InputError&) {
                loads = false;
            }
            EXPECT_EQ(loads, model["loadable"].get<bool>()) << path;
        }
}

}  // namespace
}  // namespace petzval::io
