// SPDX-License-Identifier: Apache-2.0
// Reference sphere: the wave that would be focused perfectly on an image point, against which that
// of a lens is measured.
#pragma once

#include <array>

#include "camera/bench/aimed_bundle.h"

namespace petzval::camera {

[[nodiscard]] inline double square(double a) {
    return a * a;
}

/// Sphere about an image point on the film, through the middle of the paraxial exit pupil.
struct ReferenceSphere {
    double film_mm;                    ///< from the first vertex
    std::array<double, 2> image_mm{};  ///< x, y of its centre
    /// 1 / radius; above 0 where the pupil lies before the film. 0, a plane, where the pupil is at
    /// infinity, and where it lies so near the film that rays would miss the sphere.
    double curvature_1_mm = 0;
    double index = 1;          ///< of the medium before the film
    double chief_path_mm = 0;  ///< of the chief ray, as opd_mm counts it
};
/// Reference sphere of a bundle about an image point. Rims do not stop the chief ray.
[[nodiscard]] ReferenceSphere reference_sphere(const AimedBundle&, double film_mm,
                                               std::array<double, 2> image_mm);

/// Where and when a ray meets the reference sphere, lane by lane. N as of BundlePassage.
template <class N>
struct ReferenceRay {
    /// Optical direction cosines along x and y, index times the unit vector from where the ray
    /// meets the sphere to its centre: on a plane, those of the ray.
    N p, q;
    /// Optical path difference, mm: that of the chief ray less that of this ray, up to the sphere;
    /// above 0 where the wave is ahead of it. Welford 1986, Aberrations of Optical Systems, ch. 7.
    ValueOf<N> opd_mm;
    ValueOf<N> stop_x, stop_y;  ///< in radii of the stop
    ValueOf<N> inside;          ///< as BundlePassage has it
    MaskOf<N> passed;           ///< no rim stops it
};
template <class N>
[[nodiscard]] ReferenceRay<N> meet_reference(const AimedBundle&, const ReferenceSphere&, N sagittal,
                                             N tangential);

/// Middle of the image of a bundle: the centroid of its rays on the film. Nothing where none
/// arrives.
[[nodiscard]] std::optional<std::array<double, 2>> image_point(const AimedBundle&, double film_mm);

/// Optical path difference of a ray of a line across the aperture.
struct OpdPoint {
    double stop;  ///< position of the ray in the stop, in its radii
    double opd_mm;
};
/// OPD fan: rays that pass, on a line through the middle of the aperture, `along` the section or
/// across it.
[[nodiscard]] std::vector<OpdPoint> opd_fan(const AimedBundle&, const ReferenceSphere&,
                                            Section along, int count = 65);

}  // namespace petzval::camera
