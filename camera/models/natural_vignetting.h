// SPDX-License-Identifier: Apache-2.0
// Natural vignetting: the light of an even scene falls towards the corners of a film behind a stop.
#pragma once

#include "camera/iris/iris.h"
#include "core/math/math.h"

namespace petzval::camera {

/// Fall-off behind a stop that stands parallel to the film, ray by ray. A film point gets cos theta
/// cos theta' / d^2 of the light of a stop point (Foote 1915, "Illumination from a Radiating
/// Disk"), and both cosines are z / d here: cos^4 theta over the square of the film's distance.
class NaturalVignetting {
  public:
    /// Fall-off of a pinhole: the stop is a point.
    NaturalVignetting() = default;
    /// axial_mean: mean of the fall-off over the stop for the film's middle, where the factors will
    /// average to 1. film_mm: from the stop to the film.
    NaturalVignetting(double film_mm, double axial_mean)
        : per_film_1_mm_(static_cast<float>(1 / film_mm)),
          scale_(static_cast<float>(1 / axial_mean)) {}

    /// Factor on the weight of a ray through stop_mm. tangents: right and up, of the angles at
    /// which the film point sees the stop's middle.
    [[nodiscard]] float factor(V2f tangents, V2f stop_mm) const {
        const V2f slope = tangents + stop_mm * per_film_1_mm_;
        return scale_ / sqr(1.f + slope.dot(slope));
    }

    /// Mean of cos^4 over a round stop, seen from the film's middle: cos^2 u'. Foote's closed form
    /// on the axis, pi sin^2 u', over the stop's solid angle as a flat cap.
    [[nodiscard]] static double axial_mean(double stop_radius_mm, double film_mm) {
        const double tangent = stop_radius_mm / film_mm;
        return 1 / (1 + tangent * tangent);
    }
    /// The same for an iris of any shape, from 4,096 points of it; the error is below 1e-4.
    [[nodiscard]] static double axial_mean(const Iris&, double film_mm);

  private:
    float per_film_1_mm_ = 0, scale_ = 1;
};

}  // namespace petzval::camera
