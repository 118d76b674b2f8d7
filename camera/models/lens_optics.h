// SPDX-License-Identifier: Apache-2.0
// Lens, iris and film: rays from points of the film through drawn points of the stop. Millimetres,
// in the lens's own space.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "camera/dispersion/lens_point.h"
#include "camera/iris/iris.h"
#include "camera/lens/lens_coats.h"
#include "camera/lens/lens_options.h"
#include "camera/lens/ray_aiming.h"
#include "camera/lens/stop_bounds.h"
#include "camera/models/stop_draw.h"

namespace petzval::camera {

/// Film points of up to eight samples, each with a wavelength; lanes that are left over repeat one
/// of them.
struct LeadPoints {
    static_assert(kMostFilmPoints == NumberTraits<f8>::lanes);
    std::array<V2f, 8> film_mm;
    std::array<V2f, 8> u;  ///< [0, 1)^2, draws the point of the stop
    f8 nm{};

    LeadPoints() {
        film_mm.fill(V2f(0.f));
        u.fill(V2f(0.f));
    }
};

/// One ray from each film point. What is in a lane does not depend on the others.
struct LeadRays {
    PlanePoint<f8> stop_mm{f8{}, f8{}};  ///< drawn points of the stop
    FoundRays aimed;                     ///< at the stop
    LensRay<f8> ray;                     ///< in front of the lens, where nothing blocks it
    f8 open{};                           ///< share that the iris lets through
    /// Density of the ray in projected solid angle at the film, 1/sr.
    f8 density{};
    m8 passed{};  ///< lanes that neither iris nor rims block
};

/// Ray as it leaves the lens for the scene.
template <class S>
struct SceneRay {
    Vec3<S> origin, direction;
    int counted_from = 0;
};
/// One lane of a ray.
template <class V>
[[nodiscard]] SceneRay<ScalarOf<V>> lane_of(const LensRay<V>& ray, int i) {
    const auto at = [i](const Vec3<V>& a) { return Vec3<ScalarOf<V>>{a.x[i], a.y[i], a.z[i]}; };
    return {at(ray.origin), at(ray.direction), ray.counted_from};
}

/// Ray of the scene that was drawn for one lane of a film point.
template <class S>
struct DrawnRay {
    SceneRay<S> ray;
    int hero = 0;  ///< lane that it was drawn for
    V2f film_mm{0.f}, stop_mm{0.f};
    f4 nm{};  ///< of all lanes
};

/// Landing of a ray of the scene on the film, lane by lane.
struct LensLanding {
    f4 shift_x_mm{}, shift_y_mm{};      ///< from the film point that the ray was drawn for
    f4 open{}, drawn{}, transmitted{};  ///< as in FilmLanding
};

/// Rays of the scene that go through the lens at once, four lanes for each.
template <class V, size_t groups>
inline constexpr size_t kRaysAtOnce = groups* NumberTraits<V>::lanes / 4;

class LensOptics {
  public:
    /// film_mm: its z, behind the lens. Film points are within film_reach_mm of the axis.
    LensOptics(std::shared_ptr<const Lens>, Iris, Coating, double film_mm, double film_reach_mm);

    [[nodiscard]] const RayAimer& aimer() const { return aimer_; }
    /// Coats of the surfaces; nothing: Ideal.
    [[nodiscard]] const std::optional<CoatTables>& coats() const { return coats_; }
    [[nodiscard]] StopDraw stop_at(V2f film_mm) const {
        return {iris_, bounds_.at(film_mm.length()), film_mm};
    }
    /// Transmission of the stop at a point: that of the iris inside the rim.
    [[nodiscard]] float transmits(V2f stop_mm) const {
        return stop_mm.dot(stop_mm) <= stop_rim2_mm2_ ? iris_.transmits(stop_mm) : 0.f;
    }

    /// Points of the stop that are drawn for the film points.
    [[nodiscard]] PlanePoint<f8> drawn_stop_mm(const LeadPoints&) const;
    /// Rays aimed at points of the stop; `aimed` and stop_mm are filled in.
    [[nodiscard]] LeadRays aim(const LeadPoints&, const PlanePoint<f8>& stop_mm,
                               const LensIndices<f8>&) const;
    /// Traces aimed rays to the scene; the rest is filled in.
    void trace(const LeadPoints&, const LensIndices<f8>&, LeadRays&) const;

    /// Landings of rays of the scene, in one or two groups of lanes with their indices. V: f4, f8
    /// or d4.
    template <class V, size_t groups>
    [[nodiscard]] std::array<LensLanding, kRaysAtOnce<V, groups>> land(
        const std::array<DrawnRay<ScalarOf<V>>, kRaysAtOnce<V, groups>>&,
        const std::array<LensIndices<V>, groups>&) const;

    /// Share of the light that the surfaces do not reflect on the way from a film point with
    /// direction cosines l and m, lane by lane; nm in air. V: f4 or d4.
    template <class V>
    [[nodiscard]] f4 transmitted(V2f film_mm, V l, V m, const LensIndices<V>&, f4 nm) const;

  private:
    std::shared_ptr<const Lens> lens_;
    Iris iris_;
    std::optional<CoatTables> coats_;
    double film_mm_;
    float stop_rim2_mm2_;
    RayAimer aimer_;
    StopBoundsByHeight bounds_;
};

}  // namespace petzval::camera
