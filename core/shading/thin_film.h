// SPDX-License-Identifier: Apache-2.0
// Interference in a thin film over a surface, as in soap, oil and beetles:
// KHR_materials_iridescence.
#pragma once

#include "core/math/lanes.h"
#include "core/spectrum/bands.h"

namespace petzval {

struct SeenFacets;

/// Film of one index between air, or whatever lies in front, and a base. Its reflectance is Airy's
/// sum of what goes to and fro in it (Born and Wolf 1999, "Principles of Optics", 7.6.1; Belcour
/// and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
/// Iridescence", equations 3 and 8), without polarisation. Lanes of wavelengths take it at theirs.
/// Lanes of RGB take what the standard observer sees of it under D65, kept within 0 to 1: the sum's
/// terms are cosines of the optical path, whose responses a table has, so that all thicknesses,
/// indices and angles have one table.
class ThinFilm {
  public:
    ThinFilm() {}  // NOLINT(modernize-use-equals-default): nothing is set, which costs nothing
    /// index: of the film over that in front.
    ThinFilm(float index, float thickness_nm, const Bands&);

    /// Reflectance at a cosine > 0 in front, of a film over a base of the index n + ik over that in
    /// front, lane by lane.
    [[nodiscard]] f4 reflectance(float cosine, f4 n, f4 k) const;

  private:
    /// Amplitude that one interface reflects, and its square.
    struct Amplitude {
        f4 re, im;
        [[nodiscard]] f4 norm() const { return re * re + im * im; }
    };
    [[nodiscard]] f4 at_wavelengths(float front, const Amplitude& base, f4 sine, f4 cosine) const;
    [[nodiscard]] f4 in_rgb(float front, const Amplitude& base, float path_nm) const;

    bool spectral_;
    float index_, thickness_nm_;
    f4 nm_;
};

/// Index of a dielectric with this reflectance at normal incidence, 0 to 1, in air. KHR_materials_
/// iridescence takes it for that of the base.
[[nodiscard]] f4 index_for_reflectance(f4 f0);

/// Film over a base of the index n + ik, in place of its bare reflectance.
struct FilmOver {
    ThinFilm film;
    f4 n, k;
    m4 on;      ///< lanes in use
    f4 weight;  ///< share of light that meets it

    [[nodiscard]] f4 reflectance(float cosine) const {
        return zero_off(on, film.reflectance(cosine, n, k));
    }
    /// Reflectance on average over the facets.
    [[nodiscard]] f4 mean(const SeenFacets&) const;
    /// Share of light that it reflects.
    [[nodiscard]] f4 reflected(float cosine) const;
};

}  // namespace petzval
