// SPDX-License-Identifier: Apache-2.0
// From what a user asks for to something that can be rendered.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/setup/camera_report.h"
#include "apps/setup/spectral_setup.h"
#include "camera/camera.h"
#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"
#include "io/gltf/gltf.h"

namespace petzval {

/// Everything absent means: as the file has it, else a sensible choice that is reported.
struct SceneRequest {
    std::filesystem::path scene;
    V2i size{1280, 720};
    CameraRequest camera;
    std::optional<std::filesystem::path> environment;
    float environment_rotate_deg = 0, environment_strength = 1;
    std::optional<Rgb> background;
    LightChoiceKind light_choice = LightChoiceKind::Tree;
    Traversal traversal = Traversal::Robust;
    SpectralRequest spectral;
};

/// A scene that is ready: nothing in it changes any more.
struct Session {
    SceneRequest asked;
    std::shared_ptr<const std::vector<GltfCamera>> cameras;  ///< of the file
    std::shared_ptr<const Scene> scene;  ///< on the heap: bvh and lights point to it
    std::shared_ptr<const Bvh> bvh;
    std::shared_ptr<const LightChoice> lights;
    std::unique_ptr<Camera> camera;
    CameraReport camera_report;
    Observer observer;
    std::optional<Rgb> background;          ///< as asked, or what a dark scene gets
    std::optional<Rgb> visible_background;  ///< shown behind the scene in place of the environment
    uint64_t scene_hash = 0;
    std::string scale;                 ///< what RGB 1 means
    std::string dispersive_lens;       ///< name of one that sends wavelengths different ways
    std::vector<std::string> depends;  ///< on wavelength: what RGB cannot tell, in phrases
    std::string spectral_decision;     ///< what `notice` was told of it
    /// What else the pixels follow from, for the picture's metadata.
    std::vector<std::pair<std::string, std::string>> metadata;
    double load_s = 0, bvh_s = 0;
};

/// Loads the file, its sky and its camera. `notice` gets one line for everything that was chosen
/// for the user or is odd in the file. Throws InputError, of which ArgumentError where the request
/// does not fit the file. like: a session whose scene, BVH and lights are shared where the request
/// asks for the same ones; its notices about them are not repeated.
[[nodiscard]] Session open_session(const SceneRequest&,
                                   const std::function<void(const std::string&)>& notice,
                                   const Session* like = nullptr);

}  // namespace petzval
