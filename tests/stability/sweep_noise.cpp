// SPDX-License-Identifier: Apache-2.0
// Rare light in a render that stops at a noise.
#include <fmt/format.h>

#include <algorithm>

#include "integrator/render/executor.h"
#include "integrator/render/render_to_noise.h"
#include "tests/integrator/film_camera.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr int kCells = 100, kNoiseSide_px = 16;
constexpr double kNoise = 0.1, kMuch = 1.25;

/// Light between 0.5 and 1.5, and a lamp that one path of 1 / chance meets. The variance that the
/// lamp adds to a sample is 1, whatever its chance.
struct RareLamp {
    double chance;

    [[nodiscard]] double nits() const { return 1 / std::sqrt(chance * (1 - chance)); }
    [[nodiscard]] double mean() const { return 1 + chance * nits(); }
    [[nodiscard]] double variance() const { return 1. / 12 + 1; }
    [[nodiscard]] f4 radiance(const integrator::PathStart&, const Bands&, const Sampler& sampler,
                              FilmSample&, integrator::PathStats&) const {
        const V2f u = sampler.get2(Dim::Bsdf);
        const double lamp = double(u.y) < chance ? nits() : 0;
        return splat(0.5f + u.x + static_cast<float>(lamp));
    }
};

/// What renders of a cell come to, over their seeds.
struct Ends {
    double at_least = 0;   ///< share of the cells that say so
    double too_noisy = 0;  ///< share that ends without it and is much noisier than it says
    double samples = 0;    ///< of a pixel
};

Ends ends_with(double chance) {
    const RareLamp lamp{chance};
    auto target = std::make_shared<integrator::NoiseTarget>();
    target->noise = kNoise;
    target->floor_nits = 0.01;
    target->frame_px = {kNoiseSide_px, kNoiseSide_px};
    Ends out;
    for (uint32_t seed = 0; seed < kCells; ++seed) {
        integrator::RenderJob job;
        job.seed = seed;
        job.end_sample = 4096;
        job.sampler = SamplerKind::Independent;
        job.filter = Filter(FilterKind::Box, 0.5f);
        job.noise = target;
        Film film(target->frame_px, {0, 0, kNoiseSide_px, kNoiseSide_px}, {}, {}, {.blocks = true});
        integrator::ThreadExecutor executor(1);
        integrator::RenderMonitor monitor;
        const test::FilmCamera camera;
        static_cast<void>(integrator::render_to_noise(lamp, camera, job, film, executor, monitor));
        const integrator::NoiseReport said =
            integrator::noise_report(film, *target, job.end_sample);
        const double truth = std::sqrt(lamp.variance() / said.mean_samples) / lamp.mean();
        out.at_least += double(said.at_least) / kCells;
        out.too_noisy += double(said.left == 0 && truth > kMuch * kNoise) / kCells;
        out.samples += said.mean_samples / kCells;
    }
    return out;
}

}  // namespace

Finding rendered_noise() {
    Finding f{.method = "Noise at which a render stops",
              .fails = "variance, unknown to the render"};
    f.sweep = fmt::format(
        "A cell of {0} x {0} pixels that is rendered to a noise of {1}, with {2} seeds: even "
        "light, and a lamp that a share of the paths meets. The rarer, the brighter: the variance "
        "of a "
        "sample stays. The share of the cells that say \"at least\"; the share of those that do "
        "not, whose true noise is above {3} times the target; and the mean of the samples.",
        kNoiseSide_px, percent(kNoise), kCells, number(kMuch));
    f.table.columns = {"share of paths", "at least", "too noisy", "samples"};
    std::optional<double> often;
    double met = 0;  // paths of a cell, there
    for (const double chance : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6}) {
        const Ends ends = ends_with(chance);
        add_row(f, chance, percent(ends.at_least), percent(ends.too_noisy), ends.samples);
        if (often || ends.too_noisy <= 0.05) continue;
        often = chance;
        met = chance * kNoiseSide_px * kNoiseSide_px * ends.samples;
    }
    f.where = fmt::format(
        "Where a share of {} of the paths meets a lamp, or less, more than 5 % of the cells are "
        "noisier than they say: {} paths of a cell meet it there",
        number(often), number(met));
    f.instead =
        "A cell on which the light of a lamp lands by camera rays takes so many samples that 16 "
        "paths meet it. Of light that is found on other ways nothing is known before a path finds "
        "it: what it adds then is in the noise that is said.";
    return f;
}

}  // namespace petzval::stability
