// SPDX-License-Identifier: Apache-2.0
// Spectral setup: whether a render carries wavelengths, and how they become a picture.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/request/scene_request.h"
#include "apps/setup/wavelength_reasons.h"
#include "core/scene/scene.h"
#include "core/spectrum/observer.h"
#include "io/base/notice.h"

namespace petzval::apps {

enum class DecidedBy {
    User,     ///< --spectral says
    Request,  ///< what request and scene depend on
    Plan      ///< a measured prediction of the error
};

/// Choice of wavelengths or RGB for paths, and its reasons.
struct SpectralDecision {
    bool wavelengths = false;
    DecidedBy by = DecidedBy::Request;
    std::vector<WavelengthReason> reasons;  ///< all that RGB cannot show, whatever was decided
    double predicted_error = 0;             ///< of RGB, where a plan chose it
};

struct SpectralSetup {
    Observer observer;
    std::string scale;  ///< what RGB 1 means
    SpectralDecision decision;
    /// Inputs that the pixels follow from, for the picture's metadata.
    std::vector<std::pair<std::string, std::string>> metadata;
};

/// Decides between RGB and wavelengths, and reads what the decision needs. dispersive_lens: the
/// name of the camera's lens if its glass disperses, or nothing. diffracts: its iris does. `notice`
/// gets warnings about glasses and how well a response was fitted. Throws InputError for a file
/// that is not as it should be, ArgumentError for bins that a glass of the scene is not known for.
[[nodiscard]] SpectralSetup set_up_spectra(const SpectralRequest&, const Scene&,
                                           const std::string& dispersive_lens, bool diffracts,
                                           const io::Notice& notice);

}  // namespace petzval::apps
