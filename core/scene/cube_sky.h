// SPDX-License-Identifier: Apache-2.0
// Pictures of a sky in other shapes than Sky's own: six faces of a cube, spherical harmonics.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/math/math.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// Six square pictures towards +x, -x, +y, -y, +z and -z, as an eye in the middle sees them. The
/// top of the four upright ones is +y; that of +y is -z, that of -y is +z.
struct CubeFaces {
    int size;                                 ///< texels on a side
    std::array<std::vector<float>, 6> texel;  ///< RGB, row 0 at the top

    /// Radiance in a direction, bilinear within a face.
    [[nodiscard]] Rgb radiance(const V3f& direction) const;
};

/// Coefficients of real spherical harmonics up to degree 2, in the order of (0, 0), (1, -1), (1,
/// 0), (1, 1), (2, -2) ... (2, 2): Ramamoorthi and Hanrahan 2001, "An Efficient Representation for
/// Irradiance Environment Maps", equation 3.
using Harmonics = std::array<Rgb, 9>;

/// Radiance in a unit direction by harmonics of the irradiance, never below 0: each degree is
/// divided by what the cosine leaves of it (equation 8 of the same).
[[nodiscard]] Rgb radiance_of_irradiance(const Harmonics&, const V3f& direction);

/// Texels for Sky::picture, twice as wide as high: the value at each one's centre. radiance: by
/// unit direction.
[[nodiscard]] std::vector<float> sky_texels(int height,
                                            const std::function<Rgb(const V3f&)>& radiance);

}  // namespace petzval
