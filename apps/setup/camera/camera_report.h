// SPDX-License-Identifier: Apache-2.0
// Facts of a camera that was set up.
#pragma once

#include "apps/request/scene_request.h"
#include "camera/setup/focus_plane.h"
#include "io/picture/picture.h"

namespace petzval::apps {

struct CameraReport {
    std::string name;
    V3f eye, target;       ///< target: one metre ahead, or what --look-at said
    V3f orbit_about{0.f};  ///< point of the vertical axis that it turns, or would turn, about
    M44f to_world;
    bool orthographic = false;
    float ymag_m = 0;  ///< half height of an orthographic view
    float yfov_deg = 0, focal_length_mm = 0;
    V2f sensor_mm{0.f};                    ///< as much of it as the picture uses
    float lens_radius_m = 0, focus_m = 0;  ///< 0: a pinhole
    std::string lens;                      ///< name of a lens made of glass
    bool traced = false;                   ///< that lens: surface by surface, by a prescription
    double film_mm = 0, stop_radius_mm = 0;
    std::string dispersive_lens;             ///< its name, where its glass sends wavelengths apart
    std::optional<bool> natural_vignetting;  ///< where asked for, or photographic exposure decides
    CameraRequest asked;  ///< the user's request, and the file's where that is silent

    [[nodiscard]] camera::DispersionMode dispersion() const {
        return asked.dispersion_by(!dispersive_lens.empty());
    }
    [[nodiscard]] camera::FocusPlane focus_plane() const {
        return {eye, (target - eye).normalized(), focus_m};
    }
};

/// Adds a report to a picture's metadata.
void describe_camera(const CameraReport&, io::Metadata&);

}  // namespace petzval::apps
