// SPDX-License-Identifier: Apache-2.0
#include "apps/request/field_kinds.h"
#include "apps/request/field_members.h"
#include "apps/request/field_rows.h"
#include "apps/request/parse.h"

namespace petzval::apps {
namespace {

constexpr double kLargest = 1e6;  ///< keeps every product of two numbers a float

std::vector<RequestField> sampling_fields() {
    return {method(number("max-depth", in::path(&integrator::PathOptions::max_depth), {0, 10000},
                          "scatterings of a path, without those at clear glass (default 16)")),
            method(number("max-clear-depth", in::path(&integrator::PathOptions::max_specular_depth),
                          {0, 100000},
                          "reflections and refractions of a path at clear glass (default 256)")),
            method(choice("filter", in::samples(&SampleRequest::filter),
                          "pixel filter: box, gauss, blackman-harris (default)")),
            method(number("filter-radius", in::samples(&SampleRequest::filter_radius_px),
                          {0.01, 16, kPixels}, "pixels (default: box 0.5, the others 1.5)")),
            method(choice("sampler", in::samples(&SampleRequest::sampler),
                          "owen (default), sobol, independent")),
            method(choice(
                "light-choice", in::scene(&SceneRequest::light_choice),
                "how one of many lights is chosen: tree (default; power, distance and direction), "
                "power, uniform")),
            method(choice(
                "targets", in::scene(&SceneRequest::targets),
                "camera rays to small lamps and highlights out of focus: auto (default; where they "
                "pay), off")),
            method(number(
                "clamp", in::samples(&SampleRequest::clamp_nits), {1e-9, 1e12},
                "largest R, G or B of a sample, in nits: takes fireflies, and light with them")),
            method(choice("traversal", in::scene(&SceneRequest::traversal),
                          "robust (default): watertight; fast: may leak at edges"))};
}

Rgb parse_background(const std::string& option, const std::string& text) {
    const auto v = parse_numbers(option, text, 3);
    if (*std::min_element(v.begin(), v.end()) < 0) throw ValueError(option, "is negative");
    return Rgb(v[0], v[1], v[2]);
}

std::vector<RequestField> light_fields() {
    return {
        common(
            text("env", in::scene(&SceneRequest::environment),
                 "equirectangular environment picture, .hdr or .exr, or studio: the light that is "
                 "built in")),
        number("env-rotate", in::scene(&SceneRequest::environment_rotate_deg),
               {-kLargest, kLargest, kDegrees}, "degrees about +y, counter-clockwise from above"),
        method(number("env-strength", in::scene(&SceneRequest::environment_strength), {0, kLargest},
                      "factor on the environment")),
        common(parsed(
            "background", in::scene(&SceneRequest::background),
            "R,G,B in nits: a uniform environment; with ⟨env⟩ only what the camera sees behind",
            parse_background,
            [](const Rgb& b) { return fmt::format("{},{},{}", b.v[0], b.v[1], b.v[2]); }))};
}

std::vector<RequestField> spectrum_fields() {
    return {
        common(choice(
            "spectral", in::spectral(&SpectralRequest::mode),
            "what a path carries: rgb, wavelengths (four), or auto (default): wavelengths where "
            "something depends on them and rgb is not surely within ⟨tolerance⟩")),
        with_between(
            parsed("bins", in::spectral(&SpectralRequest::bins),
                   "FIRST:LAST:WIDTH in nm, as 380:730:10: a spectrum for each pixel of the EXR, "
                   "with its standard error",
                   parse_bins,
                   [](const Bins& bins) {
                       return fmt::format("{}:{}:{}", bins.first_edge_nm, bins.last_edge_nm(),
                                          bins.width_nm);
                   }),
            ':'),
        text("illuminant", in::spectral(&SpectralRequest::illuminant),
             "what white RGB light means: d65 (default), a, f11, FILE.csv"),
        text("response", in::spectral(&SpectralRequest::response),
             "sensitivities of R, G and B: cie1931 (default), FILE.csv"),
        method(choice("white-balance", in::spectral(&SpectralRequest::white_balance),
                      "none (default); illuminant: the illuminant looks white"))};
}

}  // namespace

std::vector<RequestField> path_fields() {
    std::vector<RequestField> all = in_group("", kRender | kPlan, sampling_fields());
    const auto add = [&](std::vector<RequestField> fields) {
        for (RequestField& field : fields) all.push_back(std::move(field));
    };
    add(in_group("Light", kPictures, light_fields()));
    add(in_group("Light", kRender | kPlan,
                 {flag("transparent", in::path(&integrator::PathOptions::transparent), true,
                       "the sky lights the scene but is not seen: alpha 0")}));
    add(in_group("Spectrum", kPictures, spectrum_fields()));
    return all;
}

}  // namespace petzval::apps
