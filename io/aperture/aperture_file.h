// SPDX-License-Identifier: Apache-2.0
// Iris shapes by name and from files.
#pragma once

#include <filesystem>
#include <string>

#include "camera/iris/aperture.h"
#include "io/picture/picture_budget.h"

namespace petzval::io {

/// Iris shape by name: circle, square, triangle, rhomboid, frame, star:N,
/// polygon:N[,ROTATION_DEG[,ROUNDNESS]], or a file: .svg, or any picture that read_picture() reads.
/// A relative file name starts at `folder`, or where the program runs. Throws ArgumentError, which
/// lists what is possible, and InputError for a file that is not as it must be.
[[nodiscard]] camera::ApertureShape parse_aperture(const std::string& text,
                                                   const std::filesystem::path& folder = {},
                                                   PictureBudget pictures = PictureBudget());

/// Polygon of the one shape in an SVG file: path, polygon, circle, ellipse or rect, with the
/// transforms of its own and of its groups. Its fill counts, not its stroke; fill-rule is nonzero
/// where not given. The middle of the viewBox lies on the optical axis; where there is none, that
/// of the shape's bounding box. Throws InputError where there is no shape or more than one, and for
/// what cannot be filled.
[[nodiscard]] camera::Polygon read_svg_aperture(const std::filesystem::path&);

/// Transmission mask from a picture: the luminance (weights of Rec. 709) of the values as they are
/// stored, without decoding, times alpha: a grey of 50 % lets 50 % through. Its middle lies on the
/// optical axis. Throws InputError where it is black everywhere or leaves [0, 1].
[[nodiscard]] camera::Mask read_mask_aperture(const std::filesystem::path&, PictureBudget pictures);

}  // namespace petzval::io
