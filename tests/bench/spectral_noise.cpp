// SPDX-License-Identifier: Apache-2.0
// What wavelengths cost: CPU time a sample and noise of hero renders against RGB ones, in pairs, in
// one run. One thread. Noise is the variance over seeds, so that no reference is needed: spectra
// that meet twice differ from RGB by more than noise.
//
//   spectral_noise SCENE [--look-at ...] [--fov ...] [--env ...] [--size ...] [--spp ...]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/parse.h"
#include "integrator/executor.h"
#include "integrator/render.h"
#include "io/session.h"
#include "io/stats_file.h"

namespace petzval {
namespace {

constexpr uint32_t kSeeds = 8;

struct Noise {
    double luminance = 0, chroma = 0;  ///< mean over pixels of variance / (mean luminance^2 + 0.01)
};

// Chroma: what is left of a colour's variance when its luminance's is taken away, as the summed
// variance of R - Y, G - Y and B - Y.
Noise noise_of(const std::vector<Film>& films, V2i size) {
    Noise noise;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            std::array<double, 4> sum{}, squares{};
            for (const Film& film : films) {
                const V4f c = film.colour(x, y);
                const double l = luminance(Rgb(c.x, c.y, c.z));
                const std::array<double, 4> v{l, c.x - l, c.y - l, c.z - l};
                for (size_t i = 0; i < 4; ++i) {
                    sum[i] += v[i] / kSeeds;
                    squares[i] += v[i] * v[i] / kSeeds;
                }
            }
            const double scale = 1 / ((sum[0] * sum[0] + 0.01) * size.x * size.y);
            const auto variance = [&](size_t i) {
                return (squares[i] - sum[i] * sum[i]) * kSeeds / (kSeeds - 1.);
            };
            noise.luminance += variance(0) * scale;
            noise.chroma += (variance(1) + variance(2) + variance(3)) * scale;
        }
    return noise;
}

double timed_s(const PathTracer<>& tracer, const Camera& camera, const RenderJob& job, Film& film) {
    RenderMonitor monitor;
    ThreadExecutor executor(1);
    const double start_s = process_cpu_s();
    static_cast<void>(render(tracer, camera, job, film, executor, monitor));
    return process_cpu_s() - start_s;
}

int run(int argc, char** argv) {
    CLI::App app("Cost and noise of wavelengths against RGB.");
    SceneRequest request;
    std::string look_at, size = "240x160";
    RenderJob job;
    job.end_sample = 16;
    app.add_option("scene", request.scene)->required();
    app.add_option("--look-at", look_at);
    app.add_option("--fov", request.camera.fov_deg);
    app.add_option("--env", request.environment);
    app.add_option("--size", size);
    app.add_option("--spp", job.end_sample);
    CLI11_PARSE(app, argc, argv);
    request.size = parse_size("--size", size);
    if (!look_at.empty()) {
        const auto v = parse_numbers("--look-at", look_at, 6);
        request.camera.look_at = {V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5])};
    }
    flush_denormals();
    request.spectral.mode = SpectralMode::Hero;
    const Session session = open_session(request, [](const std::string&) {});
    const PathTracer<Bvh> tracer(*session.scene, *session.bvh, *session.lights, PathOptions());

    std::array<RenderJob, 2> jobs{job, job};
    jobs[1].observer = session.observer;
    std::array<std::vector<Film>, 2> films;
    std::vector<double> ratios;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        std::array<double, 2> cpu_s{};
        for (size_t i = 0; i < 2; ++i) {
            const size_t which = (i + seed) % 2;  // the machine's speed drifts
            jobs[which].seed = seed;
            Film film(request.size, {0, 0, request.size.x, request.size.y}, {});
            cpu_s[which] = timed_s(tracer, *session.camera, jobs[which], film);
            films[which].push_back(std::move(film));
        }
        ratios.push_back(cpu_s[1] / cpu_s[0]);
    }
    std::sort(ratios.begin(), ratios.end());
    const double cost = 0.5 * (ratios[kSeeds / 2 - 1] + ratios[kSeeds / 2]);
    const Noise rgb = noise_of(films[0], request.size), hero = noise_of(films[1], request.size);
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
    try {
        return petzval::run(argc, argv);
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}\n", e.what());
        return 1;
    }
}
