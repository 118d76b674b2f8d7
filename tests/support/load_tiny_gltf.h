// SPDX-License-Identifier: Apache-2.0
// From a TinyGltf straight to what the loader makes of it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "io/gltf/gltf.h"
#include "tests/support/tiny_gltf.h"

namespace petzval {

inline io::GltfFile load(const TinyGltf& file) {
    const TempFolder folder;
    return io::load_gltf(file.save_glb(folder.path / "test.glb"));
}

/// The one mesh of a file's scene.
inline Mesh load_mesh(const TinyGltf& file) {
    io::GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.meshes.size(), 1u);
    return loaded.scene.meshes.empty() ? Mesh{} : std::move(loaded.scene.meshes[0]);
}

inline bool contains_line(const std::vector<std::string>& lines, const std::string& part) {
    for (const std::string& line : lines)
        if (line.find(part) != std::string::npos) return true;
    return false;
}

/// Whether a file lists that extension, and it is rendered.
inline bool renders(const io::GltfFile& file, const std::string& extension) {
    for (const io::ExtensionInFile& one : file.holds.extensions)
        if (one.name == extension) return one.use == io::ExtensionUse::Rendered;
    return false;
}

}  // namespace petzval
