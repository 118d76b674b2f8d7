// SPDX-License-Identifier: Apache-2.0
// Scenes of other programs, which a user may take for one that can be read.
#pragma once

#include <filesystem>
#include <string>

namespace petzval::io {

/// Advice about a file whose ending is that of another scene format, such as .usd, .obj or .fbx:
/// the name of the format, and how it becomes glTF. Empty for any other ending.
[[nodiscard]] std::string foreign_scene_advice(const std::filesystem::path&);

}  // namespace petzval::io
