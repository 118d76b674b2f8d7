// SPDX-License-Identifier: Apache-2.0
// Where a denoiser loses light or detail, and what it says of its error there.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "apps/setup/denoised_film.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr int kSide_px = 64;
constexpr uint32_t kDenoiseSamples = 64, kPictures = 12;

/// A sample of a pixel, in nits: of a column, by two numbers between 0 and 1.
using Light = std::function<float(int x, V2f u)>;

/// What denoised pictures come to, over their seeds.
struct Denoisings {
    double noisy = 0, denoised = 0;  ///< mean squared errors, nits^2
    double held = 0;                 ///< share of the pictures whose bounds hold their error
    std::vector<double> columns;     ///< means of the denoised pictures, nits
};

Denoisings denoisings_of(const Light& light, const std::function<double(int x)>& truth) {
    Denoisings out;
    out.columns.resize(kSide_px);
    integrator::TbbExecutor executor(1);
    constexpr double kPixels = double(kSide_px) * kSide_px;
    for (uint32_t seed = 0; seed < kPictures; ++seed) {
        Film film({kSide_px, kSide_px}, {0, 0, kSide_px, kSide_px}, {}, {}, {.halves = true});
        Draws draws(seed);
        for (int y = 0; y < kSide_px; ++y)
            for (int x = 0; x < kSide_px; ++x)
                for (uint32_t i = 0; i < kDenoiseSamples; ++i) {
                    FilmSample sample;
                    sample.colour = Rgb(light(x, draws.next2()));
                    film.add(x, y, i, sample);
                }
        const auto denoised = apps::denoised_film(film, executor, false);
        double noisy = 0, squares = 0, scale = 0;
        for (int y = 0; y < kSide_px; ++y)
            for (int x = 0; x < kSide_px; ++x) {
                const double shown =
                    double(denoised->picture.colour[denoised->picture.offset(x, y)].x);
                noisy += std::pow(double(film.colour(x, y).x) - truth(x), 2) / kPixels;
                squares += std::pow(shown - truth(x), 2) / kPixels;
                out.columns[static_cast<size_t>(x)] += shown / (kSide_px * kPictures);
                scale += shown / kPixels;
            }
        // The mean over 7 x 7 pixels is about that of the picture.
        scale = scale * scale + denoised->floor_nits * denoised->floor_nits;
        const double error = scale > 0 ? std::sqrt(squares / scale) : HUGE_VAL;
        const apps::DenoisedError& said = denoised->error;
        out.held += double(error >= said.least() && error <= said.most()) / kPictures;
        out.noisy += noisy / kPictures;
        out.denoised += squares / kPictures;
    }
    return out;
}

}  // namespace

Finding denoised_rare_light() {
    Finding f{.method = "Denoising of light that few samples find",
              .fails = "bias, which the bounds miss where no sample of a picture met the light"};
    f.sweep = fmt::format(
        "{0} x {0} pixels of {1} samples, {2} pictures: even light between 0.5 and 1.5 nits, and "
        "light of 1 nit that a share of the samples finds: the rarer, the brighter. The samples of "
        "a picture that find it; the part of it that the denoised picture keeps; the squared error "
        "over that without denoising; the share of the pictures whose bounds hold the error.",
        kSide_px, kDenoiseSamples, kPictures);
    f.table.columns = {"share of samples", "found", "kept", "squares", "held"};
    std::optional<double> lost, missed;
    for (const double chance :
         {1., 0.3, 0.1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6}) {
        const auto rare = static_cast<float>(1 / chance);
        const Denoisings got = denoisings_of(
            [&](int, V2f u) { return 0.5f + u.x + (double(u.y) < chance ? rare : 0.f); },
            [](int) { return 2.; });
        double mean = 0;
        for (const double column : got.columns) mean += column / kSide_px;
        add_row(f, chance, chance * kDenoiseSamples * kSide_px * kSide_px, percent(mean - 1),
                got.denoised / got.noisy, percent(got.held));
        if (!lost && mean < 1.9) lost = chance;
        if (!missed && got.held < 0.5) missed = chance;
    }
    f.where = fmt::format(
        "Where a share of {} of the samples finds a light, or less, over a tenth of that light is "
        "lost. At {} and below, less than half of the bounds hold the error",
        number(lost), number(missed));
    f.instead =
        "Pixels that hang on fewer than 6 samples become as bright as the second-brightest about "
        "them, so that fireflies do not spread. The halves that both met such light tell what is "
        "lost, and the bounds get wider. Light that neither met is in no estimate. The picture "
        "without denoising keeps its light.";
    return f;
}

Finding denoised_detail() {
    constexpr int kPeriod_px = 8;
    Finding f{.method = "Denoising of detail that is in no guide",
              .fails = "bias, which is in the error that is said"};
    f.sweep = fmt::format(
        "{0} x {0} pixels of {1} samples, {2} pictures: light of 1 nit with stripes of {3} pixels, "
        "a sine of 0.2 nits, and noise of a pixel between a hundredth and ten times of that. The "
        "part of the stripes that the denoised picture keeps; the squared error over that without "
        "denoising; the share of the pictures whose bounds hold the error.",
        kSide_px, kDenoiseSamples, kPictures, kPeriod_px);
    f.table.columns = {"noise over detail", "kept", "squares", "held"};
    constexpr float kDetail_nits = 0.2f;
    const auto wave = [](int x) {
        return std::sin(2 * kPi * (static_cast<float>(x) + 0.5f) / kPeriod_px);
    };
    std::optional<double> halved;
    for (const double noise : {0.01, 0.03, 0.1, 0.3, 1., 3., 10.}) {
        // Even numbers between -1 and 1 have a variance of a third.
        const float spread =
            static_cast<float>(noise * std::sqrt(3. * kDenoiseSamples)) * kDetail_nits;
        const auto truth = [&](int x) { return 1 + kDetail_nits * wave(x); };
        const Denoisings got =
            denoisings_of([&](int x, V2f u) { return truth(x) + spread * (2 * u.x - 1); },
                          [&](int x) { return double(truth(x)); });
        double kept = 0;
        for (int x = 0; x < kSide_px; ++x)
            kept += (got.columns[static_cast<size_t>(x)] - 1) * double(wave(x));
        kept /= double(kDetail_nits) * kSide_px / 2;
        add_row(f, noise, percent(kept), got.denoised / got.noisy, percent(got.held));
        if (!halved && kept < 0.5) halved = noise;
    }
    f.where = fmt::format(
        "Where the noise of a pixel is {} times the height of the stripes, or more, less than half "
        "of them is kept",
        number(halved));
    f.instead =
        "Where denoising would blur more than the noise, the picture stays as it is. Below the "
        "noise samples do not tell such detail. What is in a guide (albedo, normal, distance) is "
        "kept. More samples, or the picture without denoising, show it.";
    return f;
}

}  // namespace petzval::stability
