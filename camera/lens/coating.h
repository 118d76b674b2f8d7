// SPDX-License-Identifier: Apache-2.0
// Reflection at the surfaces of a lens: unpolarised light, nothing absorbed.
#pragma once

#include "camera/lens/lens.h"
#include "camera/lens/lens_options.h"

namespace petzval::camera {

/// Index of magnesium fluoride, at all wavelengths: 1.3785 at 550 nm for the ordinary ray of the
/// crystal (Dodge 1984, Appl. Opt. 23, 1980), rounded, as evaporated films differ by more. Its
/// dispersion over the visible, 0.004, moves reflectances by a hundredth of themselves.
inline constexpr float kMgF2Index = 1.38f;
inline constexpr float kQuarterWave_nm = 550.f;

/// Light on its way from one medium into another. cosine: of incidence, 0 to 1.
struct Crossing {
    f4 index_from, index_into, cosine;
};

/// Reflected shares of the power, 0 to 1: electric field across the plane of incidence (s) and in
/// it (p).
struct Reflectance {
    f4 s, p;
    [[nodiscard]] f4 mean() const { return 0.5f * (s + p); }
};

/// Reflectance by Fresnel's equations (Born and Wolf 1999, Principles of Optics, 1.5.2); 1 where
/// light is totally reflected.
[[nodiscard]] Reflectance fresnel_reflectance(const Crossing&);

/// Reflectance of a layer of MgF2 between the two, by Airy's sum of all reflections within it (Born
/// and Wolf 1999, 1.6.4). nm: in air.
[[nodiscard]] Reflectance coated_reflectance(const Crossing&, f4 nm);

/// Transmittance of a surface, a share of light. touches_air: air is on one side and not on both.
[[nodiscard]] f4 transmittance(Coating, const Crossing&, bool touches_air, f4 nm);

/// Whether air, which is medium 0, is on one side of a surface and not on both.
template <class S>
[[nodiscard]] bool touches_air(const SurfaceFacts<S>& s) {
    return (s.medium_before == 0) != (s.medium_after == 0);
}

}  // namespace petzval::camera
