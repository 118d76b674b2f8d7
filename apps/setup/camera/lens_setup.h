// SPDX-License-Identifier: Apache-2.0
// From a lens's name to a camera: film, iris, focus and exposure.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "apps/request/scene_request.h"
#include "camera/camera.h"
#include "camera/lens/lens.h"
#include "io/base/notice.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {

/// A lens that is not yet focused.
struct LoadedLens {
    camera::Lens lens;  ///< as filed
    std::vector<std::string> warnings;
    double focal_length_mm;
    V2f film_mm;     ///< width and height, of the picture's aspect
    float yfov_rad;  ///< that a distant scene fills the film's height with, line d

    [[nodiscard]] const std::string& name() const { return lens.prescription().name; }
    [[nodiscard]] double stop_radius_mm() const;
    [[nodiscard]] bool disperses() const;
};

/// Lens from its name or file, with its film. sensor_mm: absent for the largest 3:2 rectangle in
/// the image circle, at most 36 x 24. The film is the largest rectangle of the picture's aspect in
/// it. fit_yfov_rad: the lens is scaled until a distant scene of that height fills the film. Throws
/// InputError, and ArgumentError for a lens that does not see so far to the side.
[[nodiscard]] LoadedLens load_lens_for_film(const std::string& name_or_file,
                                            std::span<const io::AgfCatalog> catalogs,
                                            std::optional<V2f> sensor_mm, float aspect,
                                            std::optional<float> fit_yfov_rad);

struct LensSetup {
    std::unique_ptr<camera::Camera> camera;
    double film_mm, stop_radius_mm, fnumber;  ///< fnumber: of the axial ray at the rim
};

/// Camera with the lens in focus. focus_m: along the axis from the middle of the entrance pupil.
/// Throws InputError or ArgumentError: a focus nearer than the lens can, an iris that is none.
[[nodiscard]] LensSetup set_up_lens(const CameraRequest&, const LoadedLens&, const M44f& to_world,
                                    float focus_m, const io::Notice& notice);

/// Camera with the lens stopped down so far that nothing is blurred, to choose a focus by. focus_m:
/// absent for far away; it decides the scale of the picture.
[[nodiscard]] std::unique_ptr<camera::Camera> viewfinder(const LoadedLens&, const M44f& to_world,
                                                         std::optional<float> focus_m);

}  // namespace petzval::apps
