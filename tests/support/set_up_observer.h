// SPDX-License-Identifier: Apache-2.0
// Observers as a render would have them.
#pragma once

#include "apps/setup/spectral_setup.h"

namespace petzval::test {

/// Wavelengths whatever the scene; what is noticed is not told.
inline Observer observer_of(apps::SpectralRequest request, const Scene& scene = Scene()) {
    request.mode = apps::SpectralMode::Wavelengths;
    return apps::set_up_spectra(request, scene, "", false, [](const std::string&) {}).observer;
}

}  // namespace petzval::test
