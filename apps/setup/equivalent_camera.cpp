// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/equivalent_camera.h"

#include <cmath>

namespace petzval {
namespace {

// The angle of view, in degrees, at which a pinhole in the entrance pupil sees the plane of focus
// as the lens does at half the height of the film; what the lens is said to see where it leaves
// that dark.
float fov_at_focus_deg(const Session& lens) {
    const CameraReport& report = lens.camera_report;
    const V3f axis = (report.target - report.eye).normalized();
    const Bands bands = Bands::rgb();
    const auto mean_on_plane = [&](float film_y) {
        V3d sum(0);
        double weight = 0;
        for (uint32_t i = 0; i < 1024; ++i) {
            const Sampler sampler(SamplerKind::Owen, 0, {0, 0, i});
            const CameraSample seen = lens.camera->sample({{0.5f, film_y}, sampler}, bands);
            for (size_t k = 0; k < seen.size(); ++k) {
                const Ray& ray = seen[k].ray;
                const float w = hsum(seen[k].weight);
                const float t = (report.focus_m - (ray.origin - report.eye).dot(axis)) /
                                ray.direction.dot(axis);
                sum += V3d(ray.origin + t * ray.direction) * double(w);
                weight += double(w);
            }
        }
        return sum / weight;
    };
    const double height_m = (mean_on_plane(0.25f) - mean_on_plane(0.75f)).length();
    if (!(height_m > 0)) return report.yfov_deg;
    return static_cast<float>(2 * std::atan(height_m / double(report.focus_m)) * 180 / M_PI);
}

}  // namespace

SceneRequest equivalent_thin_lens(SceneRequest request, const Session& session) {
    const CameraReport& report = session.camera_report;
    CameraRequest& camera = request.camera;
    camera.lens = "thin";
    camera.fov_deg = report.lens.empty() ? report.yfov_deg : fov_at_focus_deg(session);
    camera.lens_radius_m = report.lens_radius_m;
    camera.sensor_mm = report.sensor_mm;
    camera.focus = FocusDistance{report.focus_m};
    camera.fstop = camera.focal_length_mm = camera.film_distance_mm = std::nullopt;
    camera.fit = Fit::Lens;
    camera.coating = Coating::Ideal;
    camera.precision = Precision::Float;
    camera.focus_by = FocusBy::Paraxial;
    camera.glasses.clear();
    return request;
}

SceneRequest equivalent_pinhole(SceneRequest request, const Session& session) {
    request = equivalent_thin_lens(std::move(request), session);
    CameraRequest& camera = request.camera;
    camera.lens = "pinhole";
    camera.lens_radius_m = std::nullopt;
    camera.focus = std::nullopt;
    camera.aperture = std::nullopt;
    camera.aperture_scale = ApertureScale::EqualArea;
    camera.iris_sampling = std::nullopt;
    return request;
}

SceneRequest resolved_request(const Session& session) {
    SceneRequest request = session.asked;
    const CameraReport& report = session.camera_report;
    if (report.orthographic) return request;
    request.camera = report.asked;
    // So that all methods are sharp at one distance.
    if (report.focus_m > 0 && !request.camera.film_distance_mm)
        request.camera.focus = FocusDistance{report.focus_m};
    return request;
}

}  // namespace petzval
