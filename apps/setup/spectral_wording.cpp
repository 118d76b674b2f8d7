// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/spectral_wording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/base/format.h"

namespace petzval::apps {
namespace {

std::string text_of(const WavelengthReason& reason) {
    using Kind = WavelengthReason::Kind;
    const std::string material = reason.material.empty()
                                     ? "a material without a name"
                                     : fmt::format("material \"{}\"", reason.material);
    switch (reason.kind) {
        case Kind::Bins:
            return "⟨bins⟩ asks for spectra";
        case Kind::Illuminant:
            return "⟨illuminant⟩ is " + reason.what;
        case Kind::Response:
            return "⟨response⟩ is " + reason.what;
        case Kind::Lens:
            return fmt::format("lens {} disperses", reason.what);
        case Kind::Diffraction:
            return "the iris diffracts";
        case Kind::Glass:
            return fmt::format("{} disperses ({})", material, reason.what);
        case Kind::Metal:
            return fmt::format("{} is a measured metal ({})", material, reason.what);
        case Kind::Reflectance:
            return fmt::format("{} has a measured reflectance ({})", material, reason.what);
        case Kind::Film:
            return fmt::format("light interferes in the thin film of {}", material);
        case Kind::Emitter:
            return fmt::format("{} shines as illuminant {}", material, reason.what);
        case Kind::Lamp:
            break;
    }
    return "a light shines as illuminant " + reason.what;
}

std::string because(const SpectralDecision& decision) {
    const std::string reasons = text_of(decision.reasons);
    switch (decision.by) {
        case DecidedBy::User:
            return "⟨spectral⟩ says";
        case DecidedBy::Plan:
            return decision.wavelengths
                       ? reasons
                       : fmt::format("it is off by {} at most, though {}",
                                     io::percent(decision.predicted_error), reasons);
        case DecidedBy::Request:
            break;
    }
    return decision.wavelengths ? reasons : "nothing here depends on wavelength";
}

}  // namespace

std::string text_of(const std::vector<WavelengthReason>& reasons) {
    std::vector<std::string> texts;
    for (const WavelengthReason& reason : reasons)
        texts.push_back(text_of(reason) +
                        (reason.others > 0 ? fmt::format(", and {} more", reason.others) : ""));
    return fmt::format("{}", fmt::join(texts, "; "));
}

std::vector<std::string> lines_of(const SpectralDecision& decision) {
    std::vector<std::string> lines{fmt::format(
        "spectral: {}, as {}", decision.wavelengths ? "wavelengths" : "rgb", because(decision))};
    if (decision.by == DecidedBy::User && !decision.wavelengths && !decision.reasons.empty())
        lines.push_back("warning: ⟨spectral⟩ rgb cannot show that " + text_of(decision.reasons));
    return lines;
}

}  // namespace petzval::apps
