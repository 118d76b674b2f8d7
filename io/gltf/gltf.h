// SPDX-License-Identifier: Apache-2.0
// A glTF file as a scene.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "io/gltf/choices.h"
#include "io/gltf/summary.h"
#include "io/gltf/validate/camera_extras.h"
#include "io/gltf/validate/scene_extras.h"
#include "io/gltf/validate/source.h"
#include "io/picture/picture_budget.h"

namespace petzval::io {

/// A camera node of the file.
struct GltfCamera {
    std::string name;  ///< of the camera, else of its node; may be empty
    M44f to_world;     ///< rigid (scale removed): looks along -z, y up
    /// The same at time steps while the shutter is open (core/scene/motion.h); empty: it is still.
    std::vector<M44f> steps;
    bool orthographic = false;
    float yfov_rad = 0.f;
    std::optional<float> aspect;       ///< width / height, where the file gives one
    float xmag_m = 0.f, ymag_m = 0.f;  ///< half width and half height of an orthographic view
    std::vector<float> zoom;           ///< yfov_rad or ymag_m at such time steps; empty: it stays
    CameraExtras extras;
};

struct GltfFile {
    Scene scene;                      ///< not yet finished; its sky is black, or that of the file
    std::vector<GltfCamera> cameras;  ///< in depth-first order of the node tree
    std::vector<std::string> warnings;
    std::vector<std::string> remarks;  ///< what was chosen of it, one line each
    /// For `petzval info`: what the file holds, and the same as one "name: value" line each; then
    /// which of its features, besides extensions, are honoured and which are ignored.
    GltfSummary holds;
    std::vector<std::string> contents, honoured, ignored;
    std::vector<std::string> lost;  ///< what its exporter probably left out (io/gltf/exporter)
    std::string lamp_unit_doubt;    ///< likewise; empty: none
    SceneExtras extras;             ///< of the scene that is shown
    std::vector<std::filesystem::path> files;  ///< those that were read; the first is the file
    uint64_t hash = 0;
};

/// A file that is loaded at one moment of its animations after another. It is read and checked
/// once, and what is decoded of it can be given back for the next moment.
class GltfReader {
  public:
    /// Reads the file. Throws InputError, and ArgumentError where it has not what is chosen.
    GltfReader(const std::filesystem::path&, FileScope, const GltfChoices&);
    ~GltfReader();
    GltfReader(const GltfReader&) = delete;
    GltfReader& operator=(const GltfReader&) = delete;

    /// Loads the scene at a time; the other choices are those of the constructor. As load_gltf().
    [[nodiscard]] GltfFile load(PictureBudget&, double time_s);
    /// Takes the images of the scene that was loaded last, which is done with.
    void give_back(std::vector<Image>&& images);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Loads the scene that is chosen (else the default one, the first one, all root nodes). Throws
/// InputError, also where the budget is too small for the pictures of the scene, and ArgumentError
/// where it has not what is chosen.
[[nodiscard]] GltfFile load_gltf(const std::filesystem::path&, FileScope, PictureBudget&,
                                 const GltfChoices& = {});
/// Loads a scene that may name any file, with the usual budget.
[[nodiscard]] GltfFile load_gltf(const std::filesystem::path&);

}  // namespace petzval::io
