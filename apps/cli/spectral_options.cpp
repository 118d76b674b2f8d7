// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/spectral_options.h"

#include "apps/cli/choice.h"
#include "apps/cli/parse.h"

namespace petzval {

void add_spectral_options(CLI::App& app, SpectralOptions& o) {
    SpectralRequest& s = o.request;
    const auto group = [](CLI::Option* option) { return option->group("Spectrum"); };
    const auto not_empty = [](const std::string& text) {
        return text.empty() ? "is empty" : std::string();
    };
    group(add_choice<SpectralMode>(
        app, "--spectral", s.mode,
        "what a path carries: rgb, wavelengths (four), or auto "
        "(default): wavelengths where something depends on them and rgb is not surely within "
        "--tolerance"));
    group(app.add_option("--bins", o.bins,
                         "FIRST:LAST:WIDTH in nm, as 380:730:10: a spectrum for each pixel of the "
                         "EXR, with its standard error"))
        ->check(not_empty);
    group(app.add_option("--illuminant", s.illuminant,
                         "what white RGB light means: d65 (default), a, f11, FILE.csv"))
        ->check(not_empty);
    group(app.add_option("--response", s.response,
                         "sensitivities of R, G and B: cie1931 (default), FILE.csv"))
        ->check(not_empty);
    group(add_choice<WhiteBalance>(app, "--white-balance", s.white_balance,
                                   "none (default); illuminant: the illuminant looks white"));
}

void resolve(SpectralOptions& o) {
    if (o.bins.empty()) return;
    o.request.bins = parse_bins("--bins", o.bins);
    if (o.request.mode == SpectralMode::Rgb)
        throw CLI::ValidationError("--bins", "needs wavelengths: leave out --spectral rgb");
}

}  // namespace petzval
