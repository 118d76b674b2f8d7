// SPDX-License-Identifier: Apache-2.0
// Files that a render reads: none of them may be written.
#pragma once

#include <vector>

#include "apps/request/scene_request.h"
#include "io/file/overwrite.h"
#include "io/gltf/gltf.h"

namespace petzval::apps {

/// Role of the lens and the iris that a scene's camera asks for.
inline constexpr const char* kCameraFile = "a file of the scene's camera";

/// Files that the options of a request name, whether or not they are there.
[[nodiscard]] std::vector<io::NamedFile> input_files(const SceneRequest&);
/// Files that a scene file names: buffers, images, its sky, and what its cameras ask for.
[[nodiscard]] std::vector<io::NamedFile> input_files(const io::GltfFile&,
                                                     const std::filesystem::path& scene);
/// Files that come with the program and that commands read: colours, glasses, lenses, spectra.
[[nodiscard]] std::vector<io::NamedFile> own_files();

}  // namespace petzval::apps
