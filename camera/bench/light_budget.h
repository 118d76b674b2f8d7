// SPDX-License-Identifier: Apache-2.0
// Where the light goes that enters a lens: budget, transmittance, ghosts and veiling glare.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "camera/bench/aimed_bundle.h"
#include "camera/lens/lens_coats.h"

namespace petzval::camera {

/// Shares of the light that meets the first surface within its rim.
struct LightBudget {
    double in_order = 0;  ///< on the film, never reflected
    double two = 0;       ///< on the film after two reflections
    double more = 0;      ///< on the film after more
    double stopped = 0;   ///< at rims, iris and barrel, and beside the film
    double absorbed = 0;  ///< in glass and coats
    double returned = 0;  ///< out of the first surface
    [[nodiscard]] double sum() const {
        return in_order + two + more + stopped + absorbed + returned;
    }
};
/// The shares, and how tables call them.
inline constexpr std::array<std::pair<const char*, double LightBudget::*>, 6> kBudgetParts{
    {{"in order", &LightBudget::in_order},
     {"2 reflections", &LightBudget::two},
     {"more", &LightBudget::more},
     {"stopped", &LightBudget::stopped},
     {"absorbed", &LightBudget::absorbed},
     {"returned", &LightBudget::returned}}};

/// Light of a distant point at a wavelength, nm from 360 to 830, that falls on a film of that
/// radius in a plane.
struct DistantLight {
    double field_deg = 0;
    Section section = Section::Y;
    double nm = kLineD_nm;
    double film_mm = 0, film_radius_mm = 0;
};

/// Radius on the film within which light counts: of the image circle, or of the stated half field
/// where that reaches further, and a tenth; infinite where the lens's file states neither.
[[nodiscard]] double lit_radius_mm(const Lens&);

/// Budget by side x side rays over the first surface; nothing where none meets it.
[[nodiscard]] std::optional<LightBudget> light_budget(const Lens&, const LensCoats&,
                                                      const DistantLight&, int side = 24);

/// Share of the light of a bundle's rays that pass all rims which surfaces and glass let through;
/// nothing where none passes.
[[nodiscard]] std::optional<double> transmittance(const Lens&, const LensCoats&, const AimedBundle&,
                                                  double film_mm, int side = 16);

/// Light that two surfaces send to the film.
struct Ghost {
    int first, second;     ///< surfaces in the order of the reflections: second < first
    double light = 0;      ///< over the light on the film in order
    double radius_mm = 0;  ///< root mean square distance from its centroid
    double focus_mm = 0;   ///< from the film to where it is smallest
    double per_mm2 = 0;    ///< brightness: light over the area of an even disc of that radius
};
/// Ghosts of a distant point, the brightest first; empty where no light arrives in order. A ghost
/// counts as 0.01 mm in radius at least.
[[nodiscard]] std::vector<Ghost> ghosts(const Lens&, const LensCoats&, const DistantLight&,
                                        int side = 24);
/// The surface that takes part in the most light of ghosts, and its share of it; nothing without
/// ghosts.
[[nodiscard]] std::optional<std::pair<int, double>> worst_surface(const std::vector<Ghost>&);
/// Ways of a ghost's light that reaches the film, as points {z, height} in the section, mm: of
/// `count` rays across the first surface.
[[nodiscard]] std::vector<std::vector<std::array<double, 2>>> ghost_paths(const Lens&,
                                                                          const LensCoats&,
                                                                          const DistantLight&,
                                                                          const Ghost&, int count);

/// Veiling glare index: irradiance in the image of a small black hole in an even white field that
/// fills the space before the lens, over that of the field beside it, in the middle of the film
/// (ISO 9358:1994, integral method); mean of 450, 550 and 650 nm. What film and barrel would add is
/// not in it. Nothing where no light arrives.
[[nodiscard]] std::optional<double> veiling_glare(const Lens&, const LensCoats&, double film_mm,
                                                  int side = 40);

}  // namespace petzval::camera
