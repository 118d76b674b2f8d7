// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/equivalent_lens.h"

#include <cmath>
#include <numbers>

namespace petzval::camera {
namespace {

// Mean point of the plane that a film point in the middle column shows, by the rays' weights.
V3d mean_on_plane(const Camera& camera, const FocusPlane& plane, float film_y) {
    constexpr uint32_t kRays = 1024;
    V3d sum(0);
    double weight = 0;
    for (uint32_t i = 0; i < kRays; ++i) {
        const Sampler sampler(SamplerKind::Owen, 0, {0, 0, i});
        for (const CameraPath& path : camera.sample({{0.5f, film_y}, sampler}, Bands::rgb())) {
            const auto point = plane.at(path.ray);
            if (!point) continue;
            const float w = hsum(path.weight);
            sum += V3d(*point) * double(w);
            weight += double(w);
        }
    }
    return sum / weight;
}

}  // namespace

std::optional<float> equivalent_fov_deg(const Camera& camera, const FocusPlane& plane) {
    const double height_m =
        (mean_on_plane(camera, plane, 0.25f) - mean_on_plane(camera, plane, 0.75f)).length();
    if (!(height_m > 0)) return std::nullopt;
    const double distance_m = std::fmin(double(plane.distance_m), double(FocusPlane::kFar_m));
    return static_cast<float>(2 * std::atan(height_m / distance_m) * 180 / std::numbers::pi);
}

}  // namespace petzval::camera
