// SPDX-License-Identifier: Apache-2.0
// Camera without a prescription from numbers: pinhole, thin lens, single lens by formula.
#pragma once

#include <memory>
#include <optional>

#include "apps/setup/camera/camera_model.h"
#include "camera/camera.h"
#include "camera/models/thin_lens.h"
#include "io/base/notice.h"

namespace petzval::apps {

/// View of a camera as far as the request decides it, before anything of the scene is known.
struct ThinView {
    float yfov_rad, yfov_deg;  ///< both, so that an angle that is printed is the same angle
    bool angle_of_file;        ///< the angle is that of the file's camera
    bool angle_by_focal;  ///< the angle follows from the focal length: it is that of a far focus
    V2f sensor_mm;        ///< as much as the picture uses
    std::optional<double> focal_mm;  ///< absent: follows from the distance in focus
    std::optional<float> focus_m;    ///< where the place of the film decides it
};

/// View of a camera model. aspect: of the picture. scene: the file, for errors. Throws
/// ArgumentError for numbers that no lens can have together.
[[nodiscard]] ThinView thin_view(const CameraModel&, const std::string& scene, float aspect);

/// The vertical angle of view of the lens in focus: one that follows from its focal length narrows
/// as the film goes back. focus_m: absent for far away.
[[nodiscard]] float yfov_at_rad(const ThinView&, std::optional<float> focus_m);

struct ThinSetup {
    std::unique_ptr<camera::Camera> camera;
    double focal_mm, lens_radius_m = 0;  ///< radius 0: a pinhole
    double film_mm = 0;                  ///< where the film stands behind a lens in focus
    bool natural_vignetting = false;
};

/// Camera of a model. pose: with the view's angle and aspect. focus_m: absent for a pinhole. Throws
/// ArgumentError for an object within the focal length, and for an iris that is none.
[[nodiscard]] ThinSetup set_up_thin(const CameraModel&, const ThinView&, camera::ThinLens pose,
                                    std::optional<float> focus_m, const io::Notice& notice);

}  // namespace petzval::apps
