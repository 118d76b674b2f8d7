// SPDX-License-Identifier: Apache-2.0
// What the ways to carry wavelengths through a lens cost and bring, as a table: CPU time a sample,
// noise, bias, and efficiency 1 / (mean square error * CPU time) at the samples asked for. All in
// one run on one thread, turn by turn. The reference is rendered with split rays, other seeds and
// many samples, and its own variance is taken off what is called bias.
//
//   dispersion_noise SCENE --lens NAME [--fstop ...] [--focus ...] [--size ...] [--crop ...] [--spp
//   ...]
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/request/parse.h"
#include "apps/setup/render_setup.h"
#include "tests/measure/noise.h"
#include "tests/measure/program.h"

namespace petzval {
namespace {

constexpr uint32_t kSeeds = 8, kReferenceSeeds = 4, kFirstReferenceSeed = 1000;

struct Strategy {
    std::string name;
    camera::DispersionMode mode;
    apps::RenderSetup setup{};
    std::vector<Film> films{};
    std::vector<double> cpu_s{};
};

// How far apart, in pixels, rays of 450 and 650 nm from the middle of the crop meet the plane of
// focus that started in one direction: root of the mean square over the iris.
double parted_px(const apps::RenderSetup& split, const integrator::RenderJob& job, V2i size,
                 Rect crop) {
    const apps::CameraReport& report = split.from.camera;
    const V3f axis = (report.target - report.eye).normalized();
    const Bands bands =
        split.view.observer.at(f4{450, 650, 550, 550}, splat(1e-3f), m4{-1, -1, 0, 0});
    const V2f middle(0.5f * float(crop.x0 + crop.x1), 0.5f * float(crop.y0 + crop.y1));
    double sum = 0;
    int count = 0;
    for (uint32_t i = 0; i < 4096; ++i) {
        const Sampler sampler(job.sampler, job.seed, {crop.x0, crop.y0, i});
        const camera::CameraSample seen =
            split.view.still->sample({middle / V2f(size), sampler}, bands);
        if (seen.size() != 2) continue;
        const auto on_plane = [&](const Ray& ray) {
            const float t =
                (report.focus_m - (ray.origin - report.eye).dot(axis)) / ray.direction.dot(axis);
            return ray.origin + t * ray.direction;
        };
        sum += (on_plane(seen[0].ray) - on_plane(seen[1].ray)).length2();
        ++count;
    }
    const double pixel_m =
        double(report.sensor_mm.x) / size.x / report.focal_length_mm * report.focus_m;
    return std::sqrt(sum / count) / pixel_m;
}

void render_into(Strategy& strategy, integrator::RenderJob job, V2i size, Rect crop) {
    job.observer = strategy.setup.view.observer;
    const integrator::PathTracer<Bvh> tracer(
        *strategy.setup.prepared.scene, *strategy.setup.prepared.bvh,
        *strategy.setup.prepared.lights, integrator::PathOptions());
    Film film(size, crop, {});
    strategy.cpu_s.push_back(timed_s(tracer, *strategy.setup.view.camera, job, film));
    strategy.films.push_back(std::move(film));
}

// Of the mean of the seeds, squared; the variances of both means are taken off.
RelativeMean square_bias(const std::vector<PixelMoments>& of,
                         const std::vector<PixelMoments>& reference) {
    return mean_relative(reference, [&](size_t k, size_t i) {
        const double difference = of[k].mean[i] - reference[k].mean[i];
        return difference * difference - of[k].variance[i] / kSeeds -
               reference[k].variance[i] / kReferenceSeeds;
    });
}

bool significant(double value, double error) {
    return value > 3 * error;
}

// In per cent of the luminance; "< " and a bound of three standard errors where none is found.
std::string bias_text(double square, double error) {
    if (significant(square, error)) return fmt::format("{:.2f}", 100 * std::sqrt(square));
    return fmt::format("< {:.2f}", 100 * std::sqrt(std::max(square, 0.) + 3 * error));
}

void print(std::vector<Strategy>& strategies, size_t split, size_t shared,
           const std::vector<PixelMoments>& reference) {
    struct Row {
        double cost;
        LumaChroma noise, error;  ///< error: mean square
        RelativeMean bias;
    };
    std::vector<Row> rows;
    for (const Strategy& s : strategies) {
        Row row;
        std::vector<double> ratios;
        for (uint32_t seed = 0; seed < kSeeds; ++seed)
            ratios.push_back(s.cpu_s[seed] / strategies[shared].cpu_s[seed]);
        row.cost = median(ratios);
        const auto pixels = moments_of(s.films);
        row.noise = noise_of(pixels);
        row.bias = square_bias(pixels, reference);
        const auto [mean, error] = row.bias;
        const auto found = [](double v, double e) { return significant(v, e) ? v : 0.; };
        row.error = {row.noise.luminance + found(mean.luminance, error.luminance),
                     row.noise.chroma + found(mean.chroma, error.chroma)};
        rows.push_back(row);
    }
    fmt::print(
        "| | CPU | variance Y | chroma | bias Y % | chroma % | efficiency Y | chroma |\n"
        "|---|---|---|---|---|---|---|---|\n");
    const Row& one = rows[split];
    for (size_t i = 0; i < rows.size(); ++i) {
        const Row& r = rows[i];
        fmt::print("| {} | {:.2f} | {:.4f} | {:.4f} | {} | {} | {:.2f} | {:.2f} |\n",
                   strategies[i].name, r.cost, r.noise.luminance, r.noise.chroma,
                   bias_text(r.bias.mean.luminance, r.bias.error.luminance),
                   bias_text(r.bias.mean.chroma, r.bias.error.chroma),
                   one.error.luminance * one.cost / (r.error.luminance * r.cost),
                   one.error.chroma * one.cost / (r.error.chroma * r.cost));
    }
}

int run(int argc, char** argv) {
    CLI::App app("Cost, noise and bias of the ways to carry wavelengths through a lens.");
    apps::SceneRequest request;
    apps::CameraRequest& camera = request.camera;
    std::string size = "240x160", crop_text, focus = "1m";
    integrator::RenderJob job;
    job.end_sample = 64;
    uint32_t reference_spp = 1024;
    app.add_option("scene", request.scene)->required();
    app.add_option("--lens", camera.lens)->required();
    app.add_option("--fstop", camera.fstop);
    app.add_option("--focus", focus);
    app.add_option("--size", size);
    app.add_option("--crop", crop_text);
    app.add_option("--spp", job.end_sample);
    app.add_option("--reference-spp", reference_spp, "of each of four renders");
    CLI11_PARSE(app, argc, argv);
    request.size = apps::parse_size("--size", size);
    camera.focus = apps::parse_focus("--focus", focus);
    std::optional<apps::Crop> part;
    if (!crop_text.empty()) part = apps::parse_crop("--crop", crop_text);
    const Rect crop = apps::pixels_of(part, request.size);
    flush_denormals();
    request.spectral.mode = apps::SpectralMode::Wavelengths;

    std::vector<Strategy> strategies;
    strategies.push_back({"shared", camera::DispersionMode::Shared});
    strategies.push_back({"split", camera::DispersionMode::Split});
    strategies.push_back({"hero", camera::DispersionMode::Hero});
    for (Strategy& s : strategies) {
        camera.dispersion = s.mode;
        s.setup = apps::set_up_render(request, [](const std::string&) {});
    }
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        job.seed = seed;
        for (size_t i = 0; i < strategies.size(); ++i)  // the machine's speed drifts
            render_into(strategies[(i + seed) % strategies.size()], job, request.size, crop);
    }
    Strategy reference{"reference", camera::DispersionMode::Split};
    camera.dispersion = camera::DispersionMode::Split;
    reference.setup = apps::set_up_render(request, [](const std::string&) {});
    integrator::RenderJob long_job = job;
    long_job.end_sample = reference_spp;
    for (uint32_t i = 0; i < kReferenceSeeds; ++i) {
        long_job.seed = kFirstReferenceSeed + i;
        render_into(reference, long_job, request.size, crop);
    }
    const auto truth = moments_of(reference.films);
    const LumaChroma noise = noise_of(truth);
    fmt::print("{} f/{:g}, {} pixels of {}: 450 and 650 nm part by {:.2g} px\n", *camera.lens,
               camera.fstop.value_or(0), crop.width() * crop.height(), size,
               parted_px(strategies[1].setup, job, request.size, crop));
    fmt::print("{} samples, {} seeds; error of the reference: Y {:.2f} %, chroma {:.2f} %\n\n",
               job.end_sample, kSeeds, 100 * std::sqrt(noise.luminance / kReferenceSeeds),
               100 * std::sqrt(noise.chroma / kReferenceSeeds));
    print(strategies, 1, 0, truth);
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    return petzval::guarded(petzval::run, argc, argv);
}
