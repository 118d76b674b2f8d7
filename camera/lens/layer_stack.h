// SPDX-License-Identifier: Apache-2.0
// Layer stack: a coating of thin layers between two media, and what becomes of light there.
#pragma once

#include <variant>
#include <vector>

#include "camera/lens/lens_options.h"

namespace petzval::camera {

/// Thin layer of the complex index n - ik, n = index + cauchy_um2 / w^2, w in um.
struct Layer {
    double thickness_nm = 0;  ///< 0 or more
    double index = 1, cauchy_um2 = 0;
    double extinction = 0;  ///< k, 0 or more
    bool operator==(const Layer&) const = default;
};
/// Layers as light meets them that comes from the air; where no side is air, from the scene.
using LayerStack = std::vector<Layer>;

/// Coating of one surface: by its name, or layer by layer.
using SurfaceCoat = std::variant<Coating, LayerStack>;

/// Light on its way into another medium. cosine: of incidence, 0 to 1; nm: in air.
struct Incidence {
    double index_from, index_into, cosine, nm;
};

/// Shares of the power of unpolarised light that meets a surface.
struct SurfaceShares {
    double reflected = 0, transmitted = 1;
    [[nodiscard]] double absorbed() const { return 1 - reflected - transmitted; }
};

/// What becomes of light that meets a stack, by the product of the layers' characteristic matrices
/// (Macleod 2010, Thin-Film Optical Filters, 2.6; Born and Wolf 1999, 1.6.2), the mean of both
/// polarisations. reversed: it comes from the other side. Evanescent layers and total reflection
/// included; layers of any number and thickness give shares from 0 to 1.
[[nodiscard]] SurfaceShares surface_shares(const LayerStack&, bool reversed, const Incidence&);

/// Layers of a named coating between air and glass of an index, from the air; none for Ideal,
/// Uncoated, Filed and Year. All are designed for 550 nm and normal incidence.
///
/// MgF2: a quarter wave. VCoat: MgF2 over a layer of index 2.05, as thick as it takes to reflect
/// nothing (Moys 1974, Thin Solid Films 21, 145); from an index of 1.38^2 on, MgF2 alone.
/// Broadband: quarter, half and quarter wave of MgF2, index 2.05 and index 1.38 sqrt(glass), after
/// Cox, Hass and Thelen 1962, J. Opt. Soc. Am. 52, 965.
[[nodiscard]] LayerStack layers_of(Coating, double glass_index);

/// Coating that lenses designed in a year usually had: none before 1945, one layer up to 1970, and
/// Broadband from 1971 on. (Smakula's patent for Zeiss is of November 1935, and coated lenses were
/// sold widely after the war; Asahi sold the first lenses with several layers on all surfaces in
/// 1971.) Single lenses were earlier or later.
[[nodiscard]] constexpr Coating usual_in(int year) {
    return year < 1945 ? Coating::Uncoated : year < 1971 ? Coating::MgF2 : Coating::Broadband;
}

}  // namespace petzval::camera
