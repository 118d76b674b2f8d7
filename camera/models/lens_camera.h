// SPDX-License-Identifier: Apache-2.0
// The camera that is a lens: rays leave the film, cross the iris, and go out through the glass.
#pragma once

#include <memory>

#include "camera/camera.h"
#include "camera/dispersion/dispersion_mode.h"
#include "camera/iris/iris.h"
#include "camera/lens/coating.h"
#include "camera/lens/lens.h"
#include "camera/lens/lens_options.h"
#include "camera/lens/ray_aiming.h"
#include "camera/models/thin_lens.h"

namespace petzval {

/// A draw of the iris. V: f4 or d4.
template <class V>
struct LensDraw {
    V weight{};      ///< 0 where the lane is blocked
    LensRay<V> ray;  ///< in front of the lens
    LensLosses<uint32_t> lanes;
};

struct LensCameraInput {
    std::shared_ptr<const Lens> lens;
    Iris iris;
    M44f to_world;       ///< the middle of the entrance pupil, looking along -z, y up
    double film_mm = 0;  ///< z of the film, behind the lens
    double film_width_mm = 36, film_height_mm = 24;
    double entrance_pupil_mm = 0;  ///< z of what stands at to_world's origin
    DispersionMode dispersion = DispersionMode::Tolerance;
    float focus_m = 1;        ///< where wavelengths are compared, along the axis
    float tolerance_rad = 0;  ///< Tolerance: how far apart directions may be, seen from the lens
    Coating coating = Coating::Ideal;
    Precision precision = Precision::Float;  ///< of sample()
};

class LensCamera final : public Camera {
  public:
    explicit LensCamera(LensCameraInput);

    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;

    /// From here on weights average to the exposure in the middle of the film, where they averaged
    /// to its irradiance(). axial: that irradiance, before the first call.
    void set_exposure(double exposure, double axial) {
        exposure_ = static_cast<float>(exposure);
        gain_ = static_cast<float>(exposure / axial);
    }
    /// Irradiance at a film point over the radiance of an even scene, at line d, the gain included,
    /// but not what surfaces reflect; on the axis pi sin^2 u' for a round iris. From `count` draws,
    /// best a power of two: with 1024 the error is below 1e-4 for the lenses that ship, and 0.2 %
    /// where a rim just touches the bundle.
    [[nodiscard]] double irradiance(V2f film_mm, uint32_t count) const;

    /// What one draw of the iris brings: a film point's irradiance over the radiance of a scene of
    /// the same radiance everywhere is its mean. Lanes of the bands; u in [0, 1)^2. film_mm: a
    /// point of the film. u_lane picks the lane whose ray hits the drawn iris point. V: f4 or d4.
    template <class V = f4>
    [[nodiscard]] LensDraw<V> draw(V2f film_mm, V2f u, float u_lane, const Bands& bands) const {
        return draw<V>(film_mm, u, u_lane, bands, in_.coating, in_.dispersion);
    }

  private:
    /// A draw's film point, number, lane that is solved for, and wavelength.
    struct Aim {
        V2f film_mm, u;
        int lane;
        float nm;
    };
    template <class V>
    [[nodiscard]] LensDraw<V> draw(V2f film_mm, V2f u, float u_lane, const Bands&, Coating,
                                   DispersionMode) const;
    /// Solved with the indices in floats, traced with the others.
    template <class V>
    [[nodiscard]] LensDraw<V> draw(const Aim&, const Bands&, Coating, DispersionMode,
                                   const LensIndices<f4>&, const LensIndices<V>&) const;
    /// What the surfaces let through of the ray that leaves the film towards the crossing.
    template <class V>
    [[nodiscard]] f4 transmitted(V2f film_mm, const AimedRay<V>&, Coating, const LensIndices<V>&,
                                 f4 nm) const;
    template <class V>
    [[nodiscard]] CameraSample hero(const FilmPoint&, V2f film_mm, const Bands&) const;
    template <class V>
    [[nodiscard]] CameraSample paths(const LensDraw<V>&, const Bands&, DispersionMode) const;
    template <class V>
    [[nodiscard]] Ray world_ray(const LensRay<V>&, int lane) const;
    /// How far the ray's origin lies behind the middle of the entrance pupil.
    template <class V>
    [[nodiscard]] ScalarOf<V> behind_pupil_mm(const LensRay<V>&, int lane) const;
    template <class V>
    [[nodiscard]] bool together(const LensRay<V>&, int a, int b, DispersionMode) const;
    /// Whether all lanes have the ray of line d.
    [[nodiscard]] static bool one_ray(const Bands& bands, DispersionMode dispersion) {
        return !bands.spectral || dispersion == DispersionMode::Shared;
    }

    LensCameraInput in_;
    Pose pose_;
    RayAimer aimer_;
    LensIndices<f4> line_d_;
    LensIndices<d4> exact_line_d_;
    float gain_ = 1.f, exposure_ = 1.f;
};

}  // namespace petzval
