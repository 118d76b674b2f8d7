// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/schema/extensions.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "io/gltf/validate/source.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

TEST(GltfExtensions, SayWhatTheyDoToThePictureUnlessTheyAreRendered) {
    for (const GltfExtension& extension : gltf_extensions())
        EXPECT_EQ(extension.effect.empty(), extension.use == ExtensionUse::Rendered)
            << extension.name;
}

TEST(GltfExtensions, AreFoundByName) {
    for (const GltfExtension& extension : gltf_extensions())
        EXPECT_EQ(find_gltf_extension(extension.name), &extension);
    EXPECT_EQ(find_gltf_extension("KHR_materials"), nullptr);
    EXPECT_EQ(find_gltf_extension(""), nullptr);
}

/// Second cell of each row of README.md's tables that begins with a known extension.
std::map<std::string, std::string> in_readme() {
    std::ifstream readme(PETZVAL_ASSETS "/../README.md");
    std::map<std::string, std::string> found;
    for (std::string line; std::getline(readme, line);) {
        std::istringstream words(line);
        std::string bar, name, second_bar, word;
        words >> bar >> name >> second_bar >> word;
        if (bar == "|" && find_gltf_extension(name)) found[name] = word;
    }
    return found;
}

TEST(GltfExtensions, AreInTheReadmeAsTheyAre) {
    const auto readme = in_readme();
    for (const auto& [name, word] : readme) {
        const ExtensionUse use = find_gltf_extension(name)->use;
        EXPECT_EQ(word, use == ExtensionUse::Rendered       ? "yes"
                        : use == ExtensionUse::Approximated ? "partly"
                                                            : "no")
            << name;
    }
    for (const GltfExtension& extension : gltf_extensions())
        EXPECT_TRUE((extension.use != ExtensionUse::Rendered &&
                     extension.use != ExtensionUse::Approximated) ||
                    readme.contains(std::string(extension.name)))
            << extension.name;
}

TEST(GltfExtensions, AreReadOfFilesThatAreRefusedForOne) {
    const TempFolder folder;
    TinyGltf file;
    file.json["extensionsUsed"] =
        file.json["extensionsRequired"] = {"KHR_gaussian_splatting", "KHR_xmp_json_ld"};
    const auto path = file.save_glb(folder.path / "a.glb");
    EXPECT_NE(refusal([&] { (void)read_gltf_source(path); }), "");
    const auto extensions = read_gltf_extensions(path);
    ASSERT_EQ(extensions.size(), 2u);
    EXPECT_TRUE(extensions[0].refused());
    EXPECT_FALSE(extensions[1].refused());
    EXPECT_NE(refusal([&] { (void)read_gltf_extensions(folder.path / "none.glb"); }), "");
}

// Of a file that is refused nothing is shown, so its table says what to do instead.
TEST(GltfExtensions, SayOfARefusalWhatToDo) {
    const TempFolder folder;
    int needed = 0;
    for (const GltfExtension& extension : gltf_extensions()) {
        if (extension.use != ExtensionUse::Needed) continue;
        ++needed;
        TinyGltf file;
        file.json["extensionsUsed"] = {extension.name};
        const auto used = read_gltf_extensions(file.save_glb(folder.path / "used.glb"));
        EXPECT_EQ(used.at(0).effect, extension.effect);
        file.json["extensionsRequired"] = {extension.name};
        const auto path = file.save_glb(folder.path / "required.glb");
        const auto required = read_gltf_extensions(path);
        EXPECT_EQ(required.at(0).effect, gltf_extension_advice(extension.name));
        EXPECT_TRUE(has(refusal([&] { (void)read_gltf_source(path); }), required[0].effect));
    }
    EXPECT_GT(needed, 3);
}

}  // namespace
}  // namespace petzval::io
