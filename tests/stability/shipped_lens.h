// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/models/lens_camera.h"
#include "io/lens/lens_file.h"

namespace petzval::stability {

/// A lens that ships, wide open and in focus as it ships.
struct ShippedLens {
    std::shared_ptr<const camera::Lens> lens;
    double stop_mm, half_circle_mm;

    explicit ShippedLens(const std::string& name) {
        camera::Prescription p = io::load_lens(name).lens;
        half_circle_mm = 0.5 * (p.image_circle_mm > 0 ? p.image_circle_mm : 43.27);
        lens = std::make_shared<const camera::Lens>(std::move(p));
        stop_mm = lens->prescription().surfaces[static_cast<size_t>(lens->stop())].semi_diameter_mm;
    }
    /// Camera at the origin with a film of that size.
    [[nodiscard]] camera::LensCamera camera(double width_mm, double height_mm) const {
        return camera::LensCamera(input(width_mm, height_mm));
    }
    [[nodiscard]] camera::LensCameraInput input(double width_mm, double height_mm) const {
        camera::LensCameraInput in{
            .lens = lens, .iris = camera::Iris(camera::Disk{}, stop_mm), .to_world = M44f()};
        in.film_mm = lens->film_mm();
        in.film_width_mm = width_mm;
        in.film_height_mm = height_mm;
        in.dispersion = camera::DispersionMode::Shared;
        return in;
    }
};

}  // namespace petzval::stability
