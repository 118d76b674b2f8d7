// SPDX-License-Identifier: Apache-2.0
// Channel names of spectral pictures: Fichet, Pacanowski and Wilkie 2021, "An OpenEXR Layout for
// Spectral Images", Journal of Computer Graphics Techniques 10 (3), section 3.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/picture/picture.h"

namespace petzval::io {

/// Channel name of unpolarised light at a wavelength, "S0.385,0nm": rounded to picometres, always
/// with a comma.
[[nodiscard]] std::string spectral_channel(double nm);
/// The wavelength in nm of a channel S0 of any writer: digits with a decimal comma, an exponent,
/// and metres or hertz with or without a prefix, as S0.3,85e-7m or S0.780THz. Nothing for other
/// names.
[[nodiscard]] std::optional<double> spectral_channel_nm(std::string_view name);

/// Spectral channel: its wavelength, and its index among a picture's channels.
struct SpectralChannel {
    double nm;
    size_t index;
};
/// The channels S0 of a layer, as "denoised.", from short waves to long; "" is the picture itself.
/// None in a picture that is not spectral.
[[nodiscard]] std::vector<SpectralChannel> spectral_channels(const PictureLayout&,
                                                             std::string_view layer = "");

/// Spectra of a pixel: wavelength in nm and value, from short waves to long.
struct PixelSpectra {
    std::vector<std::array<double, 2>> picture;
    std::vector<std::array<double, 2>> denoised;  ///< none where the picture has no such layer
};
/// Spectra of one pixel x, y of the full frame. Throws ArgumentError, which names the file, for a
/// picture that is not spectral and for a pixel that it does not hold.
[[nodiscard]] PixelSpectra spectra_of_pixel(const Picture&, const std::filesystem::path& file,
                                            int x, int y);

}  // namespace petzval::io
