// SPDX-License-Identifier: Apache-2.0
// Render setup: all that a render needs, from what a user asks for.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/request/scene_request.h"
#include "apps/setup/camera/camera_report.h"
#include "apps/setup/phase.h"
#include "apps/setup/spectral_setup.h"
#include "camera/camera.h"
#include "camera/shutter.h"
#include "camera/target.h"
#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"
#include "integrator/prepass/lost_light.h"
#include "integrator/render/velocity.h"
#include "io/base/notice.h"
#include "io/gltf/gltf.h"

namespace petzval::camera {

struct Diffraction;
class GhostDraws;

}  // namespace petzval::camera

namespace petzval::apps {

/// A loaded scene that views of it share. Nothing in it changes any more; copies are cheap.
struct PreparedScene {
    std::shared_ptr<const Scene> scene;  ///< on the heap: bvh and lights point to it
    std::shared_ptr<const Bvh> bvh;
    std::shared_ptr<const LightChoice> lights;
    std::shared_ptr<const std::vector<io::GltfCamera>> cameras;  ///< of the file
    /// As asked, that of the file, or what a dark scene gets.
    std::optional<std::filesystem::path> environment;
    float environment_rotate_deg = 0;
    std::string environment_text;                   ///< its name and hash, as it was read
    uint64_t hash = 0;                              ///< of the file
    std::vector<io::NamedFile> files;               ///< that the scene names
    io::PictureBudget pictures;                     ///< what the scene and its sky left of it
    std::vector<integrator::LostLight> lost_light;  ///< that no path finds
    io::SceneExtras extras;                         ///< what the file asks for
    std::shared_ptr<const io::GltfSummary> holds;   ///< of the file
    std::string lamp_unit_doubt;                    ///< as GltfFile has it
};

/// Data that the frames of a sequence, which differ in their time alone, keep from earlier ones.
struct FrameReuse {
    std::unique_ptr<io::GltfReader> reader;
    /// Scene of the frame before. Its images and sky serve the next one once nobody else has it.
    std::shared_ptr<Scene> before;
    std::string environment_text;  ///< of its sky; empty: none was asked for
};

/// Camera and observer of a prepared scene.
struct View {
    std::shared_ptr<const camera::Camera>
        camera;  ///< that renders: with its targets and its shutter
    /// The same in the middle of the exposure and without targets, for whoever asks where rays go.
    std::shared_ptr<const camera::Camera> still;
    std::unique_ptr<camera::Camera> finder;                  ///< as still, with a narrow iris
    std::shared_ptr<const camera::TargetGrid> targets;       ///< nullptr: none
    std::shared_ptr<const camera::GhostDraws> ghosts;        ///< nullptr: none are shown
    std::shared_ptr<const camera::Diffraction> diffraction;  ///< nullptr: rays alone
    std::shared_ptr<const camera::Shutter> shutter;          ///< nullptr: nothing moves
    std::optional<size_t> of_file;  ///< the camera's index among those of the file
    Observer observer;
    std::optional<Rgb> visible_background;  ///< shown behind the scene in place of the environment
};

/// Origin of a render: what was asked, what was chosen for it, and the time that took.
struct Provenance {
    SceneRequest asked;
    CameraReport camera;
    SpectralDecision spectral;
    std::string scale;  ///< what RGB 1 means
    /// Other inputs that the pixels follow from, for the picture's metadata.
    std::vector<std::pair<std::string, std::string>> metadata;
    float exposure_ev = 0;          ///< of PNG and JPEG
    bool exposure_is_auto = false;  ///< a pilot found it
    double load_s = 0, bvh_s = 0;
};

struct RenderSetup {
    PreparedScene prepared;
    View view;
    Provenance from;
};

/// Loads the file, its sky and its camera. `notice` gets one line for everything that was chosen
/// for the user or is odd in the file, but for the spectral decision: spectral_wording.h words it.
/// `begins` gets Loading, Bvh and Planning, and Planning again between the steps of it: an
/// exception of it ends the setup soon. `frames`: of a sequence, which it is part of. Throws
/// InputError, of which ArgumentError where the request does not fit the file.
[[nodiscard]] RenderSetup set_up_render(const SceneRequest&, const io::Notice& notice,
                                        const PhaseSink& begins = {}, FrameReuse* frames = nullptr);

/// The next frame of a setup, for the layer of velocities.
struct NextFrame {
    io::GltfFile file;
    std::unique_ptr<integrator::Velocity> velocity;  ///< it points into the file and the setup
};

/// Loads the scene a frame later. Throws InputError, and ArgumentError where it has other meshes
/// then, or nothing is played.
[[nodiscard]] std::unique_ptr<NextFrame> set_up_velocity(const RenderSetup&, double fps);

/// Another view of a scene that is set up already. What the request asks for in the same way is
/// shared, and notices about it are not repeated; the rest is loaded anew.
[[nodiscard]] RenderSetup set_up_view(const RenderSetup&, const SceneRequest&,
                                      const io::Notice& notice, const PhaseSink& begins = {});

}  // namespace petzval::apps
