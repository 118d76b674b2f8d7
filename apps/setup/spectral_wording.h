// SPDX-License-Identifier: Apache-2.0
// The sentences in which a spectral decision is told. Nothing is decided here.
#pragma once

#include <string>
#include <vector>

#include "apps/setup/spectral_setup.h"

namespace petzval::apps {

/// The reasons as one text: "material "prism" disperses (schott:N-SF11), and 3 more; lens
/// takumar-50mm-f1.2 disperses".
[[nodiscard]] std::string text_of(const std::vector<WavelengthReason>&);

/// The line that tells the decision and its reason; after it a warning where the user chose RGB for
/// what RGB cannot show.
[[nodiscard]] std::vector<std::string> lines_of(const SpectralDecision&);

}  // namespace petzval::apps
