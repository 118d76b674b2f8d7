// SPDX-License-Identifier: Apache-2.0
// Options of a lens, without the machinery that carries them out.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace petzval::camera {

/// Coating of surfaces. Ideal: nothing is lost. Uncoated: Fresnel's reflection at every change of
/// index. MgF2: one layer of magnesium fluoride, a quarter wave thick at 550 nm and normal
/// incidence, on every surface that touches air; cemented ones stay bare. So with VCoat, two layers
/// for one wavelength, and Broadband, three for the visible (layers_of() has them). Filed: what the
/// lens's file says of each surface. Year: the usual one when the lens was designed (usual_in()).
enum class Coating : uint8_t { Ideal, Uncoated, MgF2, VCoat, Broadband, Filed, Year };
/// The name of each.
inline constexpr std::array<std::pair<std::string_view, Coating>, 7> kCoatingNames{
    {{"ideal", Coating::Ideal},
     {"uncoated", Coating::Uncoated},
     {"mgf2", Coating::MgF2},
     {"v-coat", Coating::VCoat},
     {"broadband", Coating::Broadband},
     {"filed", Coating::Filed},
     {"year", Coating::Year}}};

enum class FocusBy : uint8_t {
    Paraxial,  ///< line d, rays near the axis
    Traced  ///< the least mean square radius of the spot on the axis: F, d and C, through the iris
};

/// Number type in which a drawn ray is traced. Its direction at the film is solved for in floats
/// either way; in doubles it is then followed anew, with the glasses' own formulas, and becomes a
/// ray of floats in the world.
enum class Precision : uint8_t { Float, Double };

}  // namespace petzval::camera
