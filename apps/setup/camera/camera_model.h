// SPDX-License-Identifier: Apache-2.0
// Which camera model a request needs: pinhole, thin lens, singlet or a lens file. Decided before
// the scene is loaded, from the user's request and what the file's camera says.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/request/scene_request.h"
#include "apps/setup/camera/lens_setup.h"
#include "core/spectrum/glass.h"
#include "io/gltf/gltf.h"

namespace petzval::apps {

struct NoLens {};     ///< a pinhole
struct IdealLens {};  ///< thin, without aberrations
/// A thin lens of one glass with its aberrations.
struct SingleLens {
    Glass glass;
    double bending = 0;
    std::optional<std::array<double, 2>> radii_mm;  ///< else a focal length decides
};
using Optics = std::variant<NoLens, IdealLens, SingleLens, LoadedLens>;

struct CameraModel {
    CameraRequest asked;  ///< the user's request, and the file's where that is silent
    const io::GltfCamera* from = nullptr;  ///< absent: --look-at, or framed from the scene's bounds
    Optics optics;

    [[nodiscard]] bool has_iris() const { return !std::holds_alternative<NoLens>(optics); }
    /// Name of the lens if it sends wavelengths apart; else empty.
    [[nodiscard]] std::string dispersive_lens() const;
};

/// Camera model that a request needs. scene: the file, for errors, and for paths in it. aspect: the
/// picture's. cameras must outlive the model. Throws InputError, and ArgumentError where what is
/// asked for does not go together.
[[nodiscard]] CameraModel choose_camera_model(const CameraRequest&,
                                              const std::filesystem::path& scene, io::FileScope,
                                              const std::vector<io::GltfCamera>& cameras,
                                              float aspect);

/// Throws InputError where a camera of a confined scene names a file outside the scene's folder,
/// whether or not it is the one that is rendered.
void check_camera_files(const std::filesystem::path& scene, io::FileScope,
                        const std::vector<io::GltfCamera>&);

}  // namespace petzval::apps
