// SPDX-License-Identifier: Apache-2.0
// glTF files of one triangle with a material, and what the loader makes of that.
#pragma once

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::test::gltf_material {

using nlohmann::json;

inline void expect_rgb(const Rgb& c, float r, float g, float b) {
    EXPECT_EQ(c[0], r);
    EXPECT_EQ(c[1], g);
    EXPECT_EQ(c[2], b);
}

/// A triangle with this material, and all that its textures need: texture i has image i.
inline TinyGltf file_with(json material) {
    TinyGltf file;
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    file.add("materials", std::move(material));
    file.add_triangle({{"material", 0}, {"attributes", {{"TEXCOORD_0", uv}, {"TEXCOORD_1", uv}}}});
    file.add_root({{"mesh", 0}});
    return file;
}

/// Adds an image of one texel of that red, and a texture of it.
inline int add_texture(TinyGltf& file, uint8_t red, json more = json::object()) {
    more["source"] = file.add_image(tiny_png(1, 1, {red, 20, 30, 40}));
    return file.add("textures", std::move(more));
}

inline Material load_material(const TinyGltf& file) {
    io::GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.materials.size(), 1u);
    return loaded.scene.materials.at(loaded.scene.meshes.at(0).material);
}

inline Material material_of(json material) {
    return load_material(file_with(std::move(material)));
}

inline json extension(const char* name, json value) {
    return {{"extensions", {{name, std::move(value)}}}};
}

/// As above, declared as used.
inline TinyGltf file_with_extension(const char* name, json value) {
    TinyGltf file = file_with(extension(name, std::move(value)));
    file.json["extensionsUsed"] = {name};
    return file;
}

}  // namespace petzval::test::gltf_material
