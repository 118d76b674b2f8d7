// SPDX-License-Identifier: Apache-2.0
// What RGB shows of a thin film, against its light at each wavelength seen by the standard
// observer.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/shading/thin_film.h"
#include "core/spectrum/colorimetry.h"
#include "io/spectra/spectra.h"

namespace petzval::apps {
namespace {

V3d colour_seen(float film, float thickness_nm, float n, float cosine) {
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.on = m4{-1, -1, -1, -1};
    V3d xyz(0.), white(0.);
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
        bands.nm = splat(static_cast<float>(nm));
        const double share =
            double(ThinFilm(film, thickness_nm, bands).reflectance(cosine, splat(n), f4{})[0]);
        for (size_t c = 0; c < 3; ++c) {
            const double light = double(xyz_bar[c].at_nm(nm)) * double(d65.at_nm(nm));
            xyz[static_cast<int>(c)] += light * share;
            white[static_cast<int>(c)] += light;
        }
    }
    return srgb_to_xyz(white / white.y).inverse() * (xyz / white.y);
}

TEST(ThinFilmColour, IsThatOfTheObserver) {
    double worst = 0;
    for (const float film : {1.3f, 1.6f, 2.f})
        for (const float thickness_nm : {60.f, 100.f, 170.f, 250.f, 333.f, 400.f, 700.f, 1000.f})
            for (const float n : {1.f, 1.5f, 3.f, 12.f})
                for (const float cosine : {0.1f, 0.4f, 0.8f, 1.f}) {
                    const V3d truth = colour_seen(film, thickness_nm, n, cosine);
                    const f4 rgb = ThinFilm(film, thickness_nm, Bands::rgb())
                                       .reflectance(cosine, splat(n), f4{});
                    for (int c = 0; c < 3; ++c) {
                        const double in_gamut = std::clamp(truth[c], 0., 1.);
                        EXPECT_NEAR(double(rgb[c]), in_gamut, 0.005)
                            << "film " << film << ", " << thickness_nm << " nm, base " << n
                            << ", cosine " << cosine << ", channel " << c;
                        worst = std::max(worst, std::fabs(double(rgb[c]) - in_gamut));
                    }
                }
    RecordProperty("worst", std::to_string(worst));
}

}  // namespace
}  // namespace petzval::apps
