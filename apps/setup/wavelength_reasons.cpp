// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/wavelength_reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "io/base/ascii.h"

namespace petzval::apps {
namespace {

using Kind = WavelengthReason::Kind;

/// Keeps the first thing of each kind and counts the others.
class Reasons {
  public:
    void add(Kind kind, const std::string& what, const std::string& material = "") {
        for (WavelengthReason& known : found_)
            if (known.kind == kind) {
                ++known.others;
                return;
            }
        found_.push_back({kind, what, material});
    }
    /// Reasons in the order of the kinds.
    [[nodiscard]] std::vector<WavelengthReason> take() && {
        std::sort(found_.begin(), found_.end(),
                  [](const auto& a, const auto& b) { return a.kind < b.kind; });
        return std::move(found_);
    }

  private:
    std::vector<WavelengthReason> found_;
};

bool disperses(const Material& m) {
    return m.glass && m.refracts();
}

int32_t illuminant_of(const Light& light) {
    const auto of = [](const auto& l) -> int32_t {
        if constexpr (requires { l.illuminant; }) return l.illuminant;
        return -1;
    };
    return std::visit(of, light);
}

bool is_known(const Glass& glass, double first_nm, double last_nm) {
    return glass.first_nm <= first_nm && glass.last_nm >= last_nm;
}

std::string range_of(const Glass& glass) {
    return fmt::format("glass {} is known from {:g} to {:g} nm", glass.name, glass.first_nm,
                       glass.last_nm);
}

}  // namespace

std::vector<WavelengthReason> explicit_requests(const SpectralRequest& request) {
    std::vector<WavelengthReason> out;
    if (request.bins) out.push_back({Kind::Bins, "", ""});
    if (io::lower(request.illuminant) != kUsualIlluminant)
        out.push_back({Kind::Illuminant, request.illuminant, ""});
    if (io::lower(request.response) != kUsualResponse)
        out.push_back({Kind::Response, request.response, ""});
    return out;
}

bool asks_for_wavelengths(const SpectralRequest& request) {
    return request.mode == SpectralMode::Wavelengths || !explicit_requests(request).empty();
}

std::vector<WavelengthReason> scene_reasons(const Scene& scene) {
    Reasons reasons;
    for (const Material& m : scene.materials) {
        if (disperses(m)) reasons.add(Kind::Glass, m.glass->name, m.name);
        if (m.metal >= 0 && m.metallic > 0)
            reasons.add(Kind::Metal, scene.metals[static_cast<size_t>(m.metal)].name, m.name);
        if (m.reflectance >= 0)
            reasons.add(Kind::Reflectance,
                        scene.reflectances[static_cast<size_t>(m.reflectance)].name, m.name);
        if (m.iridescence > 0) reasons.add(Kind::Film, "", m.name);
        if (const Illuminant* white = scene.illuminant(m.illuminant); white && m.emits())
            reasons.add(Kind::Emitter, white->name, m.name);
    }
    for (const Light& light : scene.lights)
        if (const Illuminant* white = scene.illuminant(illuminant_of(light)))
            reasons.add(Kind::Lamp, white->name);
    return std::move(reasons).take();
}

std::vector<std::string> glass_range_warnings(const Scene& scene) {
    std::vector<std::string> warnings;
    std::set<std::string> named;
    for (const Material& m : scene.materials)
        if (disperses(m) && !is_known(*m.glass, kFirst_nm, kLast_nm) &&
            named.insert(m.glass->name).second)
            warnings.push_back(range_of(*m.glass) + ": the value at the end is held outside");
    return warnings;
}

std::optional<std::string> glass_beyond(const Scene& scene, double first_nm, double last_nm) {
    for (const Material& m : scene.materials)
        if (disperses(m) && !is_known(*m.glass, first_nm, last_nm))
            return fmt::format("{}, not from {:g} to {:g} nm", range_of(*m.glass), first_nm,
                               last_nm);
    return std::nullopt;
}

}  // namespace petzval::apps
