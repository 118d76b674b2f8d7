// SPDX-License-Identifier: Apache-2.0
// Cameras without glass: pinhole, thin lens, orthographic.
#pragma once

#include <optional>

#include "camera/camera.h"
#include "camera/iris/iris.h"
#include "camera/models/natural_vignetting.h"
#include "camera/models/stop_pencil.h"
#include "camera/pose.h"

namespace petzval::camera {

/// Thin lens of no aberration; without an iris it is a pinhole. It stands at the origin of its own
/// space, looks along -z with y up, and images the plane at focus_m sharply.
struct ThinLens {
    M44f to_world;
    float yfov_rad = 0.7f;  ///< full vertical angle, seen from the lens's centre
    float aspect = 1.5f;    ///< width / height of the film
    std::optional<Iris> iris;
    float focus_m = 1.f;                            ///< axial distance; may be infinite
    float exposure = 1.f;                           ///< factor on every weight
    std::optional<NaturalVignetting> vignetting{};  ///< absent: the film is evenly lit
};

class ThinLensCamera final : public Camera {
  public:
    explicit ThinLensCamera(ThinLens);
    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;
    /// The one ray of a film point through a point of the stop.
    [[nodiscard]] CameraSample through(const FilmPoint&, V2f stop_mm, const Bands&) const;
    /// Point of the stop that the film point's sampler draws.
    [[nodiscard]] V2f drawn_stop_mm(const FilmPoint&) const;
    /// Rays of a film point; a camera with an iris.
    [[nodiscard]] StopPencil pencil(V2f film) const;
    [[nodiscard]] const std::optional<Iris>& iris() const { return iris_; }
    [[nodiscard]] const Pose& pose() const { return pose_; }

  private:
    [[nodiscard]] V2f tangents(V2f film) const;

    Pose pose_;
    std::optional<Iris> iris_;
    std::optional<NaturalVignetting> vignetting_;
    float focus_m_, exposure_, tan_half_x_, tan_half_y_;
};

/// Parallel projection: half sizes of the view in metres.
class OrthographicCamera final : public Camera {
  public:
    OrthographicCamera(const M44f& to_world, float half_width_m, float half_height_m);
    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;

  private:
    Pose pose_;
    float half_width_m_, half_height_m_;
};

/// Rigid transform of a camera at eye that looks at target; up is +y, or -z where it looks along y.
[[nodiscard]] M44f look_at(const V3f& eye, const V3f& target);

}  // namespace petzval::camera
