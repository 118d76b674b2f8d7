// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/spectral_setup.h"

#include <fmt/format.h>

#include <stdexcept>

#include "apps/request/option_names.h"
#include "core/spectrum/sensor_fit.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/file/read_file.h"
#include "io/spectra/spectra.h"

namespace petzval::apps {
namespace {

bool is(const std::string& name, std::string_view usual) {
    return io::lower(name) == usual;
}

SpectralDecision decide(const SpectralRequest& request, const Scene& scene,
                        const std::string& dispersive_lens, bool diffracts) {
    SpectralDecision out;
    out.reasons = explicit_requests(request);
    if (!dispersive_lens.empty())
        out.reasons.push_back({WavelengthReason::Kind::Lens, dispersive_lens, ""});
    if (diffracts) out.reasons.push_back({WavelengthReason::Kind::Diffraction, "", ""});
    for (WavelengthReason& reason : scene_reasons(scene)) out.reasons.push_back(std::move(reason));
    if (request.mode == SpectralMode::Auto) {
        out.wavelengths = !out.reasons.empty();
    } else {
        out.by = DecidedBy::User;
        out.wavelengths = request.mode == SpectralMode::Wavelengths;
    }
    return out;
}

void warn_of_glasses(const SpectralRequest& request, const Scene& scene, const io::Notice& notice) {
    for (const std::string& warning : glass_range_warnings(scene)) notice("warning: " + warning);
    if (!request.bins) return;
    const auto beyond =
        glass_beyond(scene, request.bins->first_edge_nm, request.bins->last_edge_nm());
    if (beyond) throw io::ArgumentError("⟨bins⟩", "", *beyond);
}

std::array<V3f, 3> rows(const Matrix3& m) {
    return {V3f(m.row[0]), V3f(m.row[1]), V3f(m.row[2])};
}

// Matrix from XYZ to the film's linear sRGB: D65 is its white, or whatever the illuminant is after
// adaptation.
Matrix3 to_srgb(const SpectralRequest& request, const ObserverInput& in) {
    const auto white_of = [&](const SpectrumTable& light) {
        const V3d xyz = respond(in.xyz_bar, light);
        return xyz / xyz.y;
    };
    const V3d d65 = white_of(io::find_illuminant("d65"));
    const Matrix3 matrix = srgb_to_xyz(d65).inverse();
    if (request.white_balance == WhiteBalance::None) return matrix;
    return matrix * bradford(white_of(in.white), d65);
}

Matrix3 fitted(const SpectralRequest& request, const ObserverInput& in, const Matrix3& xyz_to_srgb,
               const io::Notice& notice) {
    if (is(request.response, kUsualResponse)) return xyz_to_srgb;
    const std::vector<SpectrumTable> training = io::training_reflectances();
    try {
        const SensorFit fit = fit_sensor(in.response, in.xyz_bar, in.white, xyz_to_srgb, training);
        notice(
            fmt::format("response {}: matrix fitted to {} reflectances, residual CIEDE2000 {:.2f} "
                        "mean, {:.2f} worst",
                        request.response, training.size(), fit.mean_delta_e, fit.worst_delta_e));
        return fit.matrix;
    } catch (const std::invalid_argument& error) {
        throw io::InputError(request.response, "", error.what());
    }
}

}  // namespace

SpectralSetup set_up_spectra(const SpectralRequest& request, const Scene& scene,
                             const std::string& dispersive_lens, bool diffracts,
                             const io::Notice& notice) {
    SpectralSetup setup;
    setup.scale = "RGB 1 = 1 nit of D65 white";
    // Names and files are checked in any mode: a typing error must not pass unnoticed.
    const SpectrumTable white = io::find_illuminant(request.illuminant);
    const auto response = io::find_response(request.response);
    setup.decision = decide(request, scene, dispersive_lens, diffracts);
    if (!setup.decision.wavelengths) {
        setup.metadata = {{"petzval:spectral", "rgb"}};
        return setup;
    }
    warn_of_glasses(request, scene, notice);
    ObserverInput in;
    in.xyz_bar = io::standard_observer();
    in.response = is(request.response, kUsualResponse) ? in.xyz_bar : response;
    in.white = white;
    in.basis = io::rgb_basis();
    for (const Illuminant& light : scene.illuminants) in.lights.push_back(light.per_nit);
    in.bins = request.bins;
    in.matrix = rows(fitted(request, in, to_srgb(request, in), notice));
    setup.observer = Observer(in);

    if (request.white_balance == WhiteBalance::Illuminant)
        setup.scale = "RGB 1 = 1 nit of the illuminant";
    setup.metadata = {{"petzval:spectral", "wavelengths"},
                      {"petzval:illuminant", io::name_and_hash(request.illuminant)},
                      {"petzval:response", io::name_and_hash(request.response)},
                      {"petzval:whiteBalance", name_of(request.white_balance)},
                      {"petzval:responseToSrgb",
                       fmt::format("{};{};{}", io::with_commas(in.matrix[0]),
                                   io::with_commas(in.matrix[1]), io::with_commas(in.matrix[2]))}};
    return setup;
}

}  // namespace petzval::apps
