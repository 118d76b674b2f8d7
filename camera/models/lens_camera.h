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
#include "camera/models/lens_optics.h"
#include "camera/models/thin_lens.h"
#include "camera/pose.h"

namespace petzval::camera {

/// One draw of the iris, lane by lane. V: f4 or d4.
template <class V>
struct LensDraw {
    V weight{};         ///< 0 where the lane is blocked
    float density = 0;  ///< CameraSample::density
    LensRay<V> ray;     ///< in front of the lens
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
    DispersionMode dispersion = DispersionMode::Split;
    Coating coating = Coating::Ideal;
    Precision precision = Precision::Float;  ///< of sample()
};

class LensCamera final : public Camera {
  public:
    explicit LensCamera(LensCameraInput);
    LensCamera(const LensCamera&) = delete;
    LensCamera& operator=(const LensCamera&) = delete;

    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const override {
        return one_of_all(point, bands);
    }
    void sample_all(std::span<const FilmPoint>, std::span<const Bands>,
                    std::span<CameraSample>) const override;

    /// Film points of a batch, their bands, and what carries the rays that are found for them.
    struct Batch {
        std::span<const FilmPoint> points;
        std::span<const Bands> bands;
        bool achromatic;
        bool of_hero;  ///< each point has one ray, that of the hero lane
        LeadPoints at;
        LensIndices<f8> indices;
    };
    [[nodiscard]] Batch batch(std::span<const FilmPoint>, std::span<const Bands>) const;
    /// Samples of a batch, from a ray of each point that crosses the stop. Changes those rays.
    void finish(const Batch&, LeadRays&, std::span<CameraSample>) const;
    /// Point of the film, mm behind the lens, and the other way round.
    [[nodiscard]] V2f film_mm(V2f film) const;
    [[nodiscard]] V2f film_of(V2f film_mm) const;
    [[nodiscard]] const LensCameraInput& input() const { return in_; }
    [[nodiscard]] const LensOptics& optics() const { return optics_; }
    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] float gain() const { return gain_; }  ///< of the weights, for the exposure
    /// Ray in front of the lens, in the world. S: float or double.
    template <class S>
    [[nodiscard]] Ray in_world(const SceneRay<S>&) const;

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
    /// film_mm: a point of the film. The ray of the hero lane hits the drawn iris point. V:
    /// f4 or d4.
    template <class V = f4>
    [[nodiscard]] LensDraw<V> draw(V2f film_mm, V2f u, const Bands&) const;

  private:
    /// Film point, the drawn point of its stop, and its bands.
    struct Place {
        V2f film_mm, stop_mm;
        const Bands& bands;
        bool achromatic;  ///< all lanes have the indices of line d
        V2f frame_px;     ///< width and height of the full frame, in which landings count

        /// Wavelengths at which coatings count.
        [[nodiscard]] f4 coating_nm() const;
    };
    /// Rays of a film point, for the strategies of camera/dispersion.
    template <class V>
    class Point;
    class LeadPoint;

    /// Distance of the ray's origin behind the middle of the entrance pupil.
    template <class S>
    [[nodiscard]] S behind_pupil_mm(const SceneRay<S>&) const;
    [[nodiscard]] FilmLanding in_pixels(const LensLanding&, V2f frame_px) const;
    [[nodiscard]] LensIndices<f8> indices_of(const LeadPoints&, bool achromatic) const;
    void land(size_t count, std::span<const Bands>, const LeadPoints&, const LeadRays&,
              std::array<LensLanding, kMostFilmPoints>&) const;

    LensCameraInput in_;
    Pose pose_;
    LensOptics optics_;
    LensIndices<f4> line_d_;
    LensIndices<f8> line_d_of_all_;
    LensIndices<d4> exact_line_d_;
    float gain_ = 1.f, exposure_ = 1.f;
};

}  // namespace petzval::camera
