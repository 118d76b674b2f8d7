// SPDX-License-Identifier: Apache-2.0
// The camera that is a lens: rays leave the film, cross the iris, and go out through the glass.
#pragma once

#include <memory>

#include "camera/camera.h"
#include "camera/chroma.h"
#include "camera/iris.h"
#include "camera/lens.h"
#include "camera/pupil.h"
#include "camera/thin_lens.h"

namespace petzval {

struct LensCameraInput {
    std::shared_ptr<const Lens> lens;
    Iris iris;
    M44f to_world;       ///< the middle of the entrance pupil, looking along -z, y up
    double film_mm = 0;  ///< z of the film, behind the lens
    double film_width_mm = 36, film_height_mm = 24;
    double entrance_pupil_mm = 0;  ///< z of what stands at to_world's origin
    Chroma chroma = Chroma::Auto;
    float focus_m = 1;        ///< where wavelengths are compared, along the axis
    float tolerance_rad = 0;  ///< Auto: how far apart directions may be, seen from the lens
};

class LensCamera final : public Camera {
  public:
    explicit LensCamera(LensCameraInput);

    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;

    /// Factor on every weight from here on; 1 before.
    void set_gain(double gain) { gain_ = static_cast<float>(gain); }
    /// Irradiance at a film point over the radiance of an even scene, at line d, the gain included;
    /// on the axis pi sin^2 u' for a round iris. Midpoints of side x side draws of the iris.
    [[nodiscard]] double irradiance(V2f film_mm, int side) const;

    /// What one draw of the iris brings: a film point's irradiance over the radiance of a scene of
    /// the same radiance everywhere is its mean. Lanes of the bands; u in [0, 1)^2.
    struct Draw {
        f4 weight{};      ///< 0 where the lane is blocked
        LensRay<f4> ray;  ///< in front of the lens
    };
    /// film_mm: a point of the film. u_lane picks the lane whose ray hits the drawn iris point.
    [[nodiscard]] Draw draw(V2f film_mm, V2f u, float u_lane, const Bands&) const;

  private:
    [[nodiscard]] Draw draw(V2f film_mm, V2f u, int lane, const Bands&, const LensIndices<f4>&,
                            float nm) const;
    [[nodiscard]] Ray world_ray(const LensRay<f4>&, int lane) const;
    /// How far the ray's origin lies behind the middle of the entrance pupil.
    [[nodiscard]] float behind_pupil_mm(const LensRay<f4>&, int lane) const;
    [[nodiscard]] bool together(const LensRay<f4>&, int a, int b) const;

    LensCameraInput in_;
    Pose pose_;
    Pupil pupil_;
    LensIndices<f4> line_d_;
    float area_mm2_, gain_ = 1.f;
};

}  // namespace petzval
