// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/extensions.h"

#include <gtest/gtest.h>

namespace petzval {
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

}  // namespace
}  // namespace petzval
