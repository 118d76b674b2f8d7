// SPDX-License-Identifier: Apache-2.0
// Thin lens with the two aberrations that have closed forms: spherical and chromatic.
#pragma once

#include "camera/dispersion/dispersion_mode.h"
#include "camera/models/thin_lens.h"
#include "camera/models/thin_lens_optics.h"

namespace petzval::camera {

/// Single lens that stands as ThinLens does. The film is where the plane at focus_m is sharp for
/// rays near the axis at the d line.
struct AberratedLens {
    M44f to_world;  ///< rigid; metres
    Singlet singlet;
    Iris iris;              ///< at the lens
    double focus_m = 1;     ///< axial distance; may be infinite
    float yfov_rad = 0.7f;  ///< full vertical angle, seen from the lens's centre
    float aspect = 1.5f;    ///< width / height of the film
    DispersionMode dispersion = DispersionMode::Split;
    float exposure = 1.f;                           ///< factor on every weight
    std::optional<NaturalVignetting> vignetting{};  ///< absent: the film is evenly lit
};

/// Camera with an aberrated lens. A ray that meets the lens h off the axis is bent as by an ideal
/// lens of focal length f(h, wavelength): zonal_focal_length_mm for the distance in focus. Coma,
/// astigmatism and curvature of field are left out: a film point images as the film's centre does.
class AberratedLensCamera final : public Camera {
  public:
    /// Throws std::invalid_argument for focus within the focal length, a lens that does not gather
    /// light at all of 360 to 830 nm, or an iris wider than its surfaces or than f(h) > f/2 allows.
    explicit AberratedLensCamera(AberratedLens);
    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;
    /// Rays of a film point through a point of the stop: one, or one for each lane.
    [[nodiscard]] CameraSample through(const FilmPoint&, V2f stop_mm, const Bands&) const;
    /// Point of the stop that the film point's sampler draws.
    [[nodiscard]] V2f drawn_stop_mm(const FilmPoint& at) const {
        return in_.iris.sample(at.sampler.get2(Dim::Lens));
    }
    /// Rays of a film point at a wavelength.
    [[nodiscard]] StopPencil pencil(V2f film, double nm) const;
    /// Whether the rays of a film point are those of the hero lane alone.
    [[nodiscard]] bool is_led(const FilmPoint&, const Bands&) const;
    [[nodiscard]] const Iris* iris() const { return &in_.iris; }
    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] double film_distance_mm() const { return film_mm_; }

  private:
    /// A film point's rays, for the strategies of camera/dispersion.
    class Point;
    [[nodiscard]] V2f tangents(V2f film) const;
    [[nodiscard]] double index_of(const Bands&, int lane) const;
    [[nodiscard]] SingletOptics optics_at(double n) const;
    [[nodiscard]] double zonal_mm(double n, double h_mm) const;

    AberratedLens in_;
    Pose pose_;
    SingletOptics at_d_;
    double focus_mm_, film_mm_;
    float tan_half_x_, tan_half_y_;
};

}  // namespace petzval::camera
