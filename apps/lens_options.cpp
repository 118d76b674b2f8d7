// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_options.h"

#include "apps/choice.h"
#include "apps/parse.h"

namespace petzval {

void add_lens_options(CLI::App& app, LensCameraRequest& r) {
    const auto group = [](CLI::Option* option) { return option->group("Lens"); };
    CLI::Option* lens = group(app.add_option(
        "--lens", r.lens, "a lens that ships (petzval lens list) or FILE.json, .dat, .zmx"));
    group(app.add_option("--aperture", r.aperture,
                         "shape of the iris: circle (default), square, triangle, rhomboid, frame, "
                         "star:N, polygon:N[,ROTATION_DEG[,ROUNDNESS]], FILE.svg, FILE.png"))
        ->needs(lens);
    group(add_choice<ApertureScale>(
        app, "--aperture-scale", r.aperture_scale,
        {{"area", ApertureScale::EqualArea}, {"inscribed", ApertureScale::Inscribed}},
        "area (default): the round stop's area; inscribed: inside the round stop"));
    group(add_choice<std::optional<IrisSampling>>(app, "--iris-sampling", r.iris_sampling,
                                                  {{"formula", IrisSampling::Formula},
                                                   {"rejection", IrisSampling::Rejection},
                                                   {"triangles", IrisSampling::Triangles}},
                                                  "formula, rejection, triangles (default: the "
                                                  "best that the shape has)"));
    group(add_choice<Chroma>(app, "--chroma", r.chroma,
                             {{"auto", Chroma::Auto},
                              {"shared", Chroma::Shared},
                              {"split", Chroma::Split},
                              {"single", Chroma::Single}},
                             "wavelengths that leave the lens apart: auto (default), shared, "
                             "split, single"));
    group(app.add_option("--chroma-tolerance", r.chroma_tolerance_px,
                         "pixels on the film within which --chroma auto shares a ray (default "
                         "0.1)"))
        ->check(number_between(0, 1000));
}

}  // namespace petzval
