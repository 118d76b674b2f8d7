// SPDX-License-Identifier: Apache-2.0
// Ray bundle: the rays of one point of the scene through a lens, at one wavelength.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "camera/lens/lens_ray.h"
#include "camera/lens/paraxial.h"
#include "core/math/math.h"

namespace petzval::camera {

/// Point of the scene whose image lies on the side of +y, or +x in Section::X.
struct ObjectPoint {
    double field_deg = 0;  ///< between the axis and the line to the entrance pupil's middle
    /// Distance of its plane from the entrance pupil, in front of the lens; where it is finite,
    /// field_deg is below 90.
    double distance_mm = std::numeric_limits<double>::infinity();
    Section section = Section::Y;
};

/// Ray of a bundle: sagittal and tangential coordinates, mm from the middle of the entrance pupil,
/// in the plane there that is square to the line from the object. Equal areas of it carry equal
/// light: exactly for a distant object, else to the square of (aperture / distance).
using PupilPoint = std::array<double, 2>;

/// Arrival of a bundle's ray, mm.
struct BundleRay {
    PupilPoint pupil_point;
    std::array<double, 2> stop_mm;  ///< x, y
    std::array<double, 2> film_mm;  ///< x, y
    std::array<double, 2> slope;    ///< dx/dz, dy/dz at the film
    double path_mm = 0;             ///< as BundlePassage has it, and on to the film
};

/// Rays of a bundle behind the lens, lane by lane. N: d4, or Dual<d4> with the derivatives by the
/// two coordinates of the pupil point.
template <class N>
struct BundlePassage {
    LensRay<N> ray;  ///< at the last surface
    /// Optical path to there from the wave of the object that passes the middle of the entrance
    /// pupil.
    ValueOf<N> path_mm{};
    ValueOf<N> stop_x{}, stop_y{};  ///< where it crosses the stop, mm
    /// Least 1 - (r / semi-diameter)^2 at the surfaces, the stop left out: above 0 within all rims.
    ValueOf<N> inside = broadcast<ValueOf<N>>(1);
    MaskOf<N> passed{};  ///< it leaves the lens for the film
};

/// Rays of an object point, traced as for rendering, in doubles. The lens must outlive it.
class AimedBundle {
  public:
    /// Finds the ray to the middle of the stop, following it from the axis outwards, and then the
    /// rays to the stop's rim. Nothing where no ray reaches the middle of the stop.
    [[nodiscard]] static std::optional<AimedBundle> aim(const Lens&, const ObjectPoint&, double nm);

    [[nodiscard]] const Lens& lens() const { return *lens_; }
    [[nodiscard]] double nm() const { return nm_; }
    [[nodiscard]] const ObjectPoint& object() const { return object_; }
    /// Chief ray: to the middle of the stop.
    [[nodiscard]] PupilPoint chief() const { return chief_; }
    /// Corners of a box about all rays that fit through the stop.
    [[nodiscard]] PupilPoint least() const { return least_; }
    [[nodiscard]] PupilPoint most() const { return most_; }

    struct Line {
        V3d origin_mm, direction;  ///< z from the first vertex; unit
    };
    [[nodiscard]] Line line(PupilPoint) const;
    /// Index of the medium before the film.
    [[nodiscard]] double film_index() const;
    /// The rays of four pupil points through the lens.
    template <class N>
    [[nodiscard]] BundlePassage<N> pass(N sagittal, N tangential, Clip) const;
    /// Arrivals of the rays that reach the film, in the order of their pupil points.
    [[nodiscard]] std::vector<BundleRay> trace(std::span<const PupilPoint>, double film_mm,
                                               Clip = Clip::Yes) const;
    /// Pupil points: the middles of side x side cells of the box, equal light each.
    [[nodiscard]] std::vector<PupilPoint> grid(int side) const;

  private:
    AimedBundle(const Lens&, const ObjectPoint&, double nm);
    template <class N>
    [[nodiscard]] LensRay<N> launched(N sagittal, N tangential) const;
    [[nodiscard]] std::optional<PupilPoint> solve(std::array<double, 2> stop_mm,
                                                  PupilPoint guess) const;
    void find_box();

    const Lens* lens_;
    ObjectPoint object_;
    double nm_, entrance_pupil_mm_;
    LensIndices<d4> indices_;
    PupilPoint chief_{}, least_{}, most_{};
};

}  // namespace petzval::camera
