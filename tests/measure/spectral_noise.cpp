// SPDX-License-Identifier: Apache-2.0
// What wavelengths cost: CPU time a sample and noise of hero renders against RGB ones, in pairs, in
// one run. One thread. Noise is the variance over seeds, so that no reference is needed: spectra
// that meet twice differ from RGB by more than noise.
//
//   spectral_noise SCENE [--look-at ...] [--fov ...] [--env ...] [--size ...] [--spp ...]
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/request/parse.h"
#include "apps/setup/render_setup.h"
#include "tests/measure/noise.h"
#include "tests/measure/program.h"

namespace petzval {
namespace {

constexpr uint32_t kSeeds = 8;

int run(int argc, char** argv) {
    CLI::App app("Cost and noise of wavelengths against RGB.");
    apps::SceneRequest request;
    std::string look_at, size = "240x160";
    integrator::RenderJob job;
    job.end_sample = 16;
    app.add_option("scene", request.scene)->required();
    app.add_option("--look-at", look_at);
    app.add_option("--fov", request.camera.fov_deg);
    app.add_option("--env", request.environment);
    app.add_option("--size", size);
    app.add_option("--spp", job.end_sample);
    CLI11_PARSE(app, argc, argv);
    request.size = apps::parse_size("--size", size);
    if (!look_at.empty()) {
        const auto v = apps::parse_numbers("--look-at", look_at, 6);
        request.camera.look_at = {V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5])};
    }
    flush_denormals();
    request.spectral.mode = apps::SpectralMode::Wavelengths;
    const apps::RenderSetup setup = apps::set_up_render(request, [](const std::string&) {});
    const integrator::PathTracer<Bvh> tracer(*setup.prepared.scene, *setup.prepared.bvh,
                                             *setup.prepared.lights, integrator::PathOptions());

    std::array<integrator::RenderJob, 2> jobs{job, job};
    jobs[1].observer = setup.view.observer;
    std::array<std::vector<Film>, 2> films;
    std::vector<double> ratios;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        std::array<double, 2> cpu_s{};
        for (size_t i = 0; i < 2; ++i) {
            const size_t which = (i + seed) % 2;  // the machine's speed drifts
            jobs[which].seed = seed;
            Film film(request.size, {0, 0, request.size.x, request.size.y}, {});
            cpu_s[which] = timed_s(tracer, *setup.view.camera, jobs[which], film);
            films[which].push_back(std::move(film));
        }
        ratios.push_back(cpu_s[1] / cpu_s[0]);
    }
    const double cost = median(ratios);
    const LumaChroma rgb = noise_of(moments_of(films[0])), hero = noise_of(moments_of(films[1]));
    fmt::print("CPU time a sample, hero / rgb: {:.3f} ({:.3f} to {:.3f})\n", cost, ratios.front(),
               ratios.back());
    fmt::print(
        "variance at {} samples: luminance rgb {:.3g} hero {:.3g}, chroma rgb {:.3g} hero "
        "{:.3g}\n",
        job.end_sample, rgb.luminance, hero.luminance, rgb.chroma, hero.chroma);
    fmt::print("error at equal time, hero / rgb: luminance {:.3f}, chroma {:.3f}\n",
               std::sqrt(cost * hero.luminance / rgb.luminance),
               std::sqrt(cost * hero.chroma / rgb.chroma));
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    return petzval::guarded(petzval::run, argc, argv);
}
