// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/spectral_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <stdexcept>

#include "apps/setup/wavelength_reasons.h"
#include "core/spectrum/sensor_fit.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/base/read_file.h"
#include "io/spectra/spectra.h"

namespace petzval {
namespace {

using Notice = std::function<void(const std::string&)>;

constexpr std::string_view kUsualIlluminant = "d65", kUsualResponse = "cie1931";

bool is(const std::string& name, std::string_view usual) {
    return lower(name) == usual;
}

std::vector<std::string> wishes(const SpectralRequest& request) {
    std::vector<std::string> found;
    if (request.bins) found.emplace_back("--bins asks for spectra");
    if (!is(request.illuminant, kUsualIlluminant))
        found.push_back(fmt::format("--illuminant is {}", request.illuminant));
    if (!is(request.response, kUsualResponse))
        found.push_back(fmt::format("--response is {}", request.response));
    return found;
}

// What of request and scene only wavelengths can show.
std::vector<std::string> reasons(const SpectralRequest& request, const Scene& scene) {
    std::vector<std::string> found = wishes(request);
    if (!request.dispersive_lens.empty())
        found.push_back(fmt::format("lens {} disperses", request.dispersive_lens));
    for (std::string& reason : reasons_for_wavelengths(scene)) found.push_back(std::move(reason));
    return found;
}

// Whether paths carry wavelengths; fills in the setup's decision and its grounds.
bool decide(const SpectralRequest& request, const Scene& scene, const Notice& notice,
            SpectralSetup& setup) {
    setup.depends = reasons(request, scene);
    const bool depends = !setup.depends.empty(), chosen = request.mode == SpectralMode::Auto;
    const bool hero = chosen ? depends : request.mode == SpectralMode::Wavelengths;
    const std::string what = fmt::format("{}", fmt::join(setup.depends, "; "));
    std::string because = request.because.empty() ? "--spectral says" : request.because;
    if (chosen) because = depends ? what : "nothing here depends on wavelength";
    setup.decision = fmt::format("spectral: {}, as {}", hero ? "hero wavelengths" : "rgb", because);
    notice(setup.decision);
    if (!hero && depends && request.because.empty())
        notice("warning: --spectral rgb cannot show that " + what);
    return hero;
}

void warn_of_glasses(const SpectralRequest& request, const Scene& scene, const Notice& notice) {
    for (const std::string& warning : glass_range_warnings(scene)) notice("warning: " + warning);
    if (!request.bins) return;
    const auto beyond =
        glass_beyond(scene, request.bins->first_edge_nm, request.bins->last_edge_nm());
    if (beyond) throw ArgumentError("--bins", "", *beyond);
}

std::array<V3f, 3> rows(const Matrix3& m) {
    return {V3f(m.row[0]), V3f(m.row[1]), V3f(m.row[2])};
}

// XYZ to the film's linear sRGB: D65 is its white, or whatever the illuminant is after adaptation.
Matrix3 to_srgb(const SpectralRequest& request, const ObserverInput& in) {
    const auto white_of = [&](const SpectrumTable& light) {
        const V3d xyz = respond(in.xyz_bar, light);
        return xyz / xyz.y;
    };
    const V3d d65 = white_of(find_illuminant("d65"));
    const Matrix3 matrix = srgb_to_xyz(d65).inverse();
    if (request.white_balance == WhiteBalance::None) return matrix;
    return matrix * bradford(white_of(in.white), d65);
}

Matrix3 fitted(const SpectralRequest& request, const ObserverInput& in, const Matrix3& xyz_to_srgb,
               const Notice& notice) {
    if (is(request.response, kUsualResponse)) return xyz_to_srgb;
    const std::vector<SpectrumTable> training = training_reflectances();
    try {
        const SensorFit fit = fit_sensor(in.response, in.xyz_bar, in.white, xyz_to_srgb, training);
        notice(
            fmt::format("response {}: matrix fitted to {} reflectances, residual CIEDE2000 {:.2f} "
                        "mean, {:.2f} worst",
                        request.response, training.size(), fit.mean_delta_e, fit.worst_delta_e));
        return fit.matrix;
    } catch (const std::invalid_argument& error) {
        throw InputError(request.response, "", error.what());
    }
}

}  // namespace

bool asks_for_wavelengths(const SpectralRequest& request) {
    return request.mode == SpectralMode::Wavelengths || !wishes(request).empty();
}

SpectralSetup set_up_spectra(const SpectralRequest& request, const Scene& scene,
                             const Notice& notice) {
    SpectralSetup setup;
    setup.scale = "RGB 1 = 1 nit of D65 white";
    // Names and files are looked at in any mode: a slip of the pen must not pass for a choice.
    const SpectrumTable white = find_illuminant(request.illuminant);
    const auto response = find_response(request.response);
    if (!decide(request, scene, notice, setup)) {
        setup.metadata = {{"petzval:spectral", "rgb"}};
        return setup;
    }
    warn_of_glasses(request, scene, notice);
    ObserverInput in;
    in.xyz_bar = standard_observer();
    in.response = is(request.response, kUsualResponse) ? in.xyz_bar : response;
    in.white = white;
    in.basis = rgb_basis();
    for (const Illuminant& light : scene.illuminants) in.lights.push_back(light.per_nit);
    in.bins = request.bins;
    in.matrix = rows(fitted(request, in, to_srgb(request, in), notice));
    setup.observer = Observer(in);

    if (request.white_balance == WhiteBalance::Illuminant)
        setup.scale = "RGB 1 = 1 nit of the illuminant";
    setup.metadata = {{"petzval:spectral", "hero"},
                      {"petzval:illuminant", name_and_hash(request.illuminant)},
                      {"petzval:response", name_and_hash(request.response)},
                      {"petzval:whiteBalance",
                       request.white_balance == WhiteBalance::None ? "none" : "illuminant"},
                      {"petzval:responseToSrgb",
                       fmt::format("{};{};{}", with_commas(in.matrix[0]), with_commas(in.matrix[1]),
                                   with_commas(in.matrix[2]))}};
    return setup;
}

}  // namespace petzval
