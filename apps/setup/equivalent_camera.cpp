// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/equivalent_camera.h"

#include <utility>

#include "camera/setup/equivalent_lens.h"

namespace petzval::apps {

SceneRequest equivalent_thin_lens(SceneRequest request, const RenderSetup& setup) {
    const CameraReport& report = setup.from.camera;
    CameraRequest& camera = request.camera;
    camera.lens = "thin";
    camera.fov_deg = report.lens.empty()
                         ? report.yfov_deg
                         : camera::equivalent_fov_deg(*setup.view.still, report.focus_plane())
                               .value_or(report.yfov_deg);
    camera.lens_radius_m = report.lens_radius_m;
    camera.sensor_mm = report.sensor_mm;
    camera.focus = FocusDistance{report.focus_m};
    camera.fstop = camera.focal_length_mm = camera.film_distance_mm = std::nullopt;
    camera.fit = Fit::Lens;
    camera.coating = camera::Coating::Ideal;
    camera.ghosts = GhostUse::Auto;
    camera.precision = camera::Precision::Float;
    camera.focus_by = camera::FocusBy::Paraxial;
    camera.glasses.clear();
    return request;
}

SceneRequest equivalent_pinhole(SceneRequest request, const RenderSetup& setup) {
    request = equivalent_thin_lens(std::move(request), setup);
    CameraRequest& camera = request.camera;
    camera.lens = "pinhole";
    camera.lens_radius_m = std::nullopt;
    camera.focus = std::nullopt;
    camera.aperture = std::nullopt;
    camera.aperture_scale = camera::ApertureScale::EqualArea;
    camera.iris_sampling = std::nullopt;
    return request;
}

SceneRequest resolved_request(const RenderSetup& setup) {
    SceneRequest request = setup.from.asked;
    const CameraReport& report = setup.from.camera;
    if (report.orthographic) return request;
    request.camera = report.asked;
    // So that all methods are sharp at one distance.
    if (report.focus_m > 0 && !request.camera.film_distance_mm)
        request.camera.focus = FocusDistance{report.focus_m};
    return request;
}

}  // namespace petzval::apps
