// SPDX-License-Identifier: Apache-2.0
// Distance that automatic focus finds, without a render.
#pragma once

#include <string>

#include "core/scene/scene.h"
#include "core/traversal/bvh.h"
#include "io/gltf/gltf.h"

namespace petzval::apps {

/// Distance that --focus auto finds, or why it finds none.
struct FoundFocus {
    float m = 0;  ///< 0: none
    std::string why_none;
};

/// Distance in focus of a camera of the file, with its own lens where the file gives one, else with
/// a thin lens of its angle of view, in a picture of the default size. camera: nullptr for the one
/// that frames a scene without cameras. The scene must be finished and in bvh; scene_file is its
/// name, scope where the files may lie that the camera names.
[[nodiscard]] FoundFocus find_auto_focus(const io::GltfCamera* camera,
                                         const std::string& scene_file, io::FileScope scope,
                                         const Scene&, const Bvh&);

}  // namespace petzval::apps
