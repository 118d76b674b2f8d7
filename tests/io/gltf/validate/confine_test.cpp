// SPDX-License-Identifier: Apache-2.0
// Which files a scene may name, and that messages do not show what is in them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/full_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

/// The message with which a scene is refused; empty where it is not.
std::string outcome(const fs::path& scene, FileScope scope) {
    try {
        (void)read_gltf_source(scene, scope);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// A scene in FOLDER/scene whose one buffer is the file of that address.
class Confine : public testing::Test {
  protected:
    Confine() {
        fs::create_directories(folder_.path / "scene/below");
        for (const char* name : {"scene/inside.bin", "scene/below/deep.bin", "outside.bin"})
            save_bytes(folder_.path / name, std::vector<uint8_t>(8, 7));
    }
    [[nodiscard]] std::string refused(const std::string& address, FileScope scope) const {
        const nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                                     {"buffers", {{{"byteLength", 4}, {"uri", address}}}}};
        const fs::path scene = folder_.path / "scene/a.gltf";
        std::ofstream(scene) << json.dump();
        return outcome(scene, scope);
    }
    TempFolder folder_;
};

TEST_F(Confine, KeepsAddressesInsideTheFolderOfTheScene) {
    for (const char* good : {"inside.bin", "./inside.bin", "below/deep.bin", "below/../inside.bin",
                             "../scene/inside.bin"})
        EXPECT_EQ(refused(good, FileScope::Confined), "") << good;
    for (const char* bad : {"../outside.bin", "below/../../outside.bin", "%2e%2e/outside.bin",
                            "../none.bin", "below/../../scene2/a.bin"}) {
        EXPECT_TRUE(has(refused(bad, FileScope::Confined), "a.gltf: /buffers/0/uri: \"")) << bad;
        EXPECT_TRUE(has(refused(bad, FileScope::Confined), "lies outside the folder")) << bad;
    }
    EXPECT_EQ(refused("../outside.bin", FileScope::Anywhere), "");
}

TEST_F(Confine, FollowsLinks) {
    fs::create_symlink("../outside.bin", folder_.path / "scene/out.bin");
    fs::create_directory_symlink("..", folder_.path / "scene/up");
    fs::create_symlink("below/deep.bin", folder_.path / "scene/in.bin");
    EXPECT_TRUE(has(refused("out.bin", FileScope::Confined), "lies outside"));
    EXPECT_TRUE(has(refused("up/outside.bin", FileScope::Confined), "lies outside"));
    EXPECT_EQ(refused("in.bin", FileScope::Confined), "");
    EXPECT_EQ(refused("up/scene/inside.bin", FileScope::Confined), "");
    EXPECT_EQ(refused("out.bin", FileScope::Anywhere), "");
    fs::create_symlink("loop.bin", folder_.path / "scene/loop.bin");
    EXPECT_TRUE(has(refused("loop.bin", FileScope::Confined), "leads back to itself"));
}

// A folder whose name begins as the scene's does is another one.
TEST_F(Confine, TakesNamesWhole) {
    fs::create_directories(folder_.path / "scene2");
    save_bytes(folder_.path / "scene2/a.bin", std::vector<uint8_t>(8, 7));
    EXPECT_TRUE(has(refused("../scene2/a.bin", FileScope::Confined), "lies outside"));
}

TEST_F(Confine, TakesAScenesFolderFromALinkOrAsTheCurrentOne) {
    EXPECT_EQ(refused("inside.bin", FileScope::Confined), "");
    const fs::path before = fs::current_path();
    fs::current_path(folder_.path / "scene");
    EXPECT_EQ(outcome("a.gltf", FileScope::Confined), "");
    fs::current_path(before);
    fs::create_directory_symlink("scene", folder_.path / "linked");
    EXPECT_EQ(outcome(folder_.path / "linked/a.gltf", FileScope::Confined), "");
}

// A buffer may be any file of the machine. Messages that quote its numbers would show it four
// bytes at a time.
TEST(Messages, DoNotShowWhatIsInABuffer) {
    constexpr uint32_t secret = 1936024690;
    TinyGltf file;
    const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int indices = file.add_accessor<uint32_t>("SCALAR", {0, secret, 2});
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    EXPECT_TRUE(has(refused_glb(file), "/indices: index 1 of accessor 1"));
    EXPECT_FALSE(has(refused_glb(file), std::to_string(secret)));

    for (const char* key : {"/accessors/7/sparse/indices"}) {
        TinyGltf sparse = full_gltf();
        const size_t view = sparse.json[nlohmann::json::json_pointer(key)]["bufferView"];
        const size_t at = sparse.json["bufferViews"][view].value("byteOffset", size_t{0});
        sparse.bin[at] = 0x39, sparse.bin[at + 1] = 0x30;  // 12345
        EXPECT_TRUE(has(refused_glb(sparse), "index 0 is beyond")) << refused_glb(sparse);
        EXPECT_FALSE(has(refused_glb(sparse), "12345"));
    }
}

TEST(Messages, DoNotShowTextThatIsNoJson) {
    const TempFolder folder;
    const fs::path path = folder.path / "a.gltf";
    for (const char* text :
         {"root:x:0:0:root:/root:/bin/bash\n", "{\"token\":\"hunter2\"}", "{\"token\": hunter2}",
          "[\"hunter2\"]", "\"hunter2\"", "{\"hunter2\":1,\"hunter2\":2}", "hunter2"}) {
        std::ofstream(path) << text;
        const std::string message = refusal([&] { (void)read_gltf_source(path); });
        EXPECT_TRUE(has(message, "a.gltf: ")) << text;
        EXPECT_FALSE(has(message, "hunter2") || has(message, "bash")) << message;
    }
}

}  // namespace
}  // namespace petzval::io
