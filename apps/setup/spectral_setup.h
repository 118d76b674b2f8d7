// SPDX-License-Identifier: Apache-2.0
// Whether a render carries wavelengths, and who looks at them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "core/spectrum/observer.h"

namespace petzval {

enum class SpectralMode { Auto, Rgb, Wavelengths };
enum class WhiteBalance { None, Illuminant };

struct SpectralRequest {
    SpectralMode mode = SpectralMode::Auto;
    std::optional<Bins> bins;
    std::string illuminant = "d65", response = "cie1931";  ///< names, or CSV files
    WhiteBalance white_balance = WhiteBalance::None;
    std::string dispersive_lens;  ///< its name, or nothing
    /// Of a mode that is not Auto: why, where a plan chose it; else the user did.
    std::string because;
};

/// Whether the request itself, whatever the scene, asks for more than RGB.
[[nodiscard]] bool asks_for_wavelengths(const SpectralRequest&);

struct SpectralSetup {
    Observer observer;
    std::string scale;                 ///< what RGB 1 means
    std::string decision;              ///< what `notice` was told of it
    std::vector<std::string> depends;  ///< phrases for what RGB cannot tell
    /// What the pixels follow from, for the picture's metadata.
    std::vector<std::pair<std::string, std::string>> metadata;
};

/// Decides between RGB and wavelengths, tells `notice` the decision with its reason, and reads what
/// the decision needs. Throws InputError for a file that is not as it should be, ArgumentError for
/// bins that a glass of the scene is not known for.
[[nodiscard]] SpectralSetup set_up_spectra(const SpectralRequest&, const Scene&,
                                           const std::function<void(const std::string&)>& notice);

}  // namespace petzval
