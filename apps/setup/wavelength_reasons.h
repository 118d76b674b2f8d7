// SPDX-License-Identifier: Apache-2.0
// Reasons to carry wavelengths: what RGB cannot show of a request and a scene. Also how far the
// scene's glasses are known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/request/scene_request.h"
#include "core/scene/scene.h"

namespace petzval::apps {

/// Reason to carry wavelengths: something depends on them.
struct WavelengthReason {
    enum class Kind {
        Bins,         ///< spectra are asked for
        Illuminant,   ///< another white is asked for
        Response,     ///< another sensor is asked for
        Lens,         ///< its glass disperses
        Diffraction,  ///< at an iris, which is asked for
        Glass,        ///< a material's glass disperses
        Metal,        ///< a material's metal is a measured one
        Reflectance,  ///< a material's reflectance is a measured one
        Film,         ///< a material has a thin film, in which light interferes
        Emitter,      ///< a material that shines as an illuminant
        Lamp          ///< a punctual light that does
    };
    Kind kind;
    std::string what;      ///< the illuminant, response, lens, glass, metal or reflectance
    std::string material;  ///< that has it; empty where it has no name or there is none
    size_t others = 0;     ///< further things of this kind

    [[nodiscard]] bool operator==(const WavelengthReason&) const = default;
};

/// Reasons in the request itself, whatever the scene.
[[nodiscard]] std::vector<WavelengthReason> explicit_requests(const SpectralRequest&);

/// Whether the request itself, whatever the scene, asks for more than RGB.
[[nodiscard]] bool asks_for_wavelengths(const SpectralRequest&);

/// Reasons in the scene: the first thing of each kind that depends on wavelength, and how many more
/// there are. Empty where RGB shows all.
[[nodiscard]] std::vector<WavelengthReason> scene_reasons(const Scene&);

/// Warnings, a line for each different glass whose formula does not cover kFirst_nm to kLast_nm.
[[nodiscard]] std::vector<std::string> glass_range_warnings(const Scene&);

/// Fault in asking for the light from first_nm to last_nm: the first glass that is not known so
/// far. Nothing where all are.
[[nodiscard]] std::optional<std::string> glass_beyond(const Scene&, double first_nm,
                                                      double last_nm);

}  // namespace petzval::apps
