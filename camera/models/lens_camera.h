// SPDX-License-Identifier: Apache-2.0
// Camera with a real lens: rays leave the film, cross the iris, and go out through the glass.
#pragma once

#include <memory>

#include "camera/camera.h"
#include "camera/dispersion/dispersion_mode.h"
#include "camera/iris/iris.h"
#include "camera/lens/coating.h"
#include "camera/lens/lens.h"
#include "camera/lens/lens_options.h"
#include "camera/lens/ray_aiming.h"
#include "camera/lens/stop_bounds.h"
#include "camera/models/stop_draw.h"
#include "camera/models/thin_lens.h"

namespace petzval {

/// One draw of the iris, lane by lane. V: f4 or d4.
template <class V>
struct LensDraw {
    V weight{};      ///< 0 where the lane is blocked
    LensRay<V> ray;  ///< in front of the lens
    LensLosses<uint32_t> losses;

    [[nodiscard]] f4 weight_of_lanes() const {
        if constexpr (std::same_as<V, f4>)
            return weight;
        else
            return __builtin_convertvector(weight, f4);
    }
};

struct LensCameraInput {
    std::shared_ptr<const Lens> lens;
    Iris iris;
    M44f to_world;       ///< from the middle of the entrance pupil, looking along -z, y up
    double film_mm = 0;  ///< z of the film, behind the lens
    double film_width_mm = 36, film_height_mm = 24;
    double entrance_pupil_mm = 0;  ///< its z, at to_world's origin
    DispersionMode dispersion = DispersionMode::Tolerance;
    float focus_m = 1;        ///< axial distance at which wavelengths are compared
    float tolerance_rad = 0;  ///< Tolerance: most angle between directions, seen from the lens
    Coating coating = Coating::Ideal;
    Precision precision = Precision::Float;  ///< of sample()
};

class LensCamera final : public Camera {
  public:
    explicit LensCamera(LensCameraInput);

    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;

    /// Scales the weights from here on: they average to the exposure in the middle of the film,
    /// where they averaged to its irradiance(). axial: that irradiance, before the first call.
    void set_exposure(double exposure, double axial) {
        exposure_ = static_cast<float>(exposure);
        gain_ = static_cast<float>(exposure / axial);
    }
    /// Irradiance at a film point over the radiance of an even scene, at line d, the gain included,
    /// but not what surfaces reflect; on the axis pi sin^2 u' for a round iris. From `count` draws,
    /// best a power of two: with 1024 the error is below 1e-4 for the lenses that ship, and 0.4 %
    /// where rims cut the bundle.
    [[nodiscard]] double irradiance(V2f film_mm, uint32_t count) const;

    /// One draw of the iris: the mean of its weights is the film point's irradiance over the
    /// radiance of a scene of the same radiance everywhere. Lanes of the bands; u in [0, 1)^2.
    /// film_mm: a point of the film. The ray of the lane that leads hits the drawn iris point. V:
    /// f4 or d4.
    template <class V = f4>
    [[nodiscard]] LensDraw<V> draw(V2f film_mm, V2f u, const Bands&) const;

  private:
    /// A film point's rays, in lanes of V, for the strategies of camera/dispersion.
    template <class V>
    class Point;
    [[nodiscard]] StopDraw stop_at(V2f film_mm) const {
        return {in_.iris, bounds_.at(film_mm.length()), film_mm};
    }
    /// Distance of the ray's origin behind the middle of the entrance pupil.
    template <class V>
    [[nodiscard]] ScalarOf<V> behind_pupil_mm(const LensRay<V>&, int lane) const;

    LensCameraInput in_;
    Pose pose_;
    RayAimer aimer_;
    LensIndices<f4> line_d_;
    LensIndices<d4> exact_line_d_;
    StopBoundsByHeight bounds_;
    float gain_ = 1.f, exposure_ = 1.f;
};

}  // namespace petzval
