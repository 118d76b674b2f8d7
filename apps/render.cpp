// SPDX-License-Identifier: Apache-2.0
#include "apps/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <thread>

#include "apps/interrupt.h"
#include "apps/parse.h"
#include "apps/progress.h"
#include "integrator/executor.h"
#include "io/develop.h"
#include "io/output.h"
#include "io/stats_file.h"

namespace petzval {
namespace {

struct RenderOptions {
    SceneRequest scene;
    std::vector<std::filesystem::path> outputs;
    std::optional<std::filesystem::path> stats;
    std::string size = "1280x720", crop, look_at, sensor, focus, time, background, aovs;
    std::optional<uint32_t> spp;
    int threads = 0;
    RenderJob job;
    PathOptions path;
    FilterKind filter = FilterKind::BlackmanHarris;
    float filter_radius_px = 0;
    DisplayOptions display;
    ProgressStyle progress = ProgressStyle::Auto;
    bool quiet = false;
};

constexpr uint32_t kDefaultSpp = 64;
constexpr uint32_t kMostSamples = 1u << 30;

template <class T>
void add_choice(CLI::App& app, const std::string& name, T& value,
                const std::map<std::string, T>& choices, const std::string& help) {
    app.add_option(name, value, help)
        ->transform(CLI::CheckedTransformer(choices, CLI::ignore_case));
}

void add_scene_options(CLI::App& app, RenderOptions& o) {
    SceneRequest& s = o.scene;
    app.add_option("scene", s.scene, "glTF scene, .gltf or .glb")->required();
    app.add_option("--camera", s.camera, "camera of the file, by name or index")->group("Camera");
    app.add_option("--look-at", o.look_at, "ex,ey,ez,tx,ty,tz: eye and target in metres")
        ->group("Camera");
    app.add_option("--fov", s.fov_deg, "vertical angle of view in degrees")
        ->check(CLI::Range(0.001, 179.0))
        ->group("Camera");
    auto* fstop = app.add_option("--fstop", s.fstop, "thin lens of this f-number")
                      ->check(CLI::PositiveNumber)
                      ->group("Camera");
    app.add_option("--lens-radius", s.lens_radius_m, "thin lens of this radius in metres")
        ->check(CLI::PositiveNumber)
        ->excludes(fstop)
        ->group("Camera");
    app.add_option("--focal-length", s.focal_length_mm,
                   "of the thin lens in mm; without --fov it sets the angle of view too")
        ->check(CLI::PositiveNumber)
        ->group("Camera");
    app.add_option("--sensor", o.sensor,
                   "WxH in mm (default 36x24), cropped to the picture's aspect")
        ->group("Camera");
    app.add_option("--focus", o.focus, "sharp plane: metres (1.5 or 1.5m), the pixel x,y, or auto")
        ->group("Camera");
    app.add_option("--env", s.environment, "equirectangular environment picture")->group("Light");
    app.add_option("--env-rotate", s.environment_rotate_deg,
                   "degrees about +y, counter-clockwise from above")
        ->group("Light");
    app.add_option("--env-strength", s.environment_strength, "factor on the environment")
        ->check(CLI::NonNegativeNumber)
        ->group("Light");
    app.add_option(
           "--background", o.background,
           "R,G,B in nits: a uniform environment; with --env only what the camera sees behind")
        ->group("Light");
    app.add_flag("--transparent", o.path.transparent,
                 "the sky lights the scene but is not seen: alpha 0")
        ->group("Light");
    add_choice<LightChoiceKind>(
        app, "--light-choice", s.light_choice,
        {{"power", LightChoiceKind::Power}, {"uniform", LightChoiceKind::Uniform}},
        "how one of many lights is chosen: power, uniform");
    add_choice<Traversal>(app, "--traversal", s.traversal,
                          {{"robust", Traversal::Robust}, {"fast", Traversal::Fast}},
                          "robust: watertight; fast: may leak at edges, builds longer");
}

void add_sampling_options(CLI::App& app, RenderOptions& o) {
    app.add_option("--size", o.size, "WIDTHxHEIGHT in pixels (default 1280x720)");
    app.add_option("--spp", o.spp, "samples of each pixel (default 64)")
        ->check(CLI::Range(1u, kMostSamples));
    app.add_option("--time", o.time,
                   "render for this long: 60s, 10m, 1h; with --spp whichever ends first");
    app.add_option("--crop", o.crop, "x,y,width,height: only these pixels of the full frame");
    app.add_option("--seed", o.job.seed, "another seed, another noise");
    app.add_option("--threads", o.threads, "default: all cores")->check(CLI::Range(1, 1024));
    app.add_option("--max-depth", o.path.max_depth, "scatterings of a path (default 16)")
        ->check(CLI::Range(0, 10000));
    add_choice<FilterKind>(app, "--filter", o.filter,
                           {{"box", FilterKind::Box},
                            {"gauss", FilterKind::Gauss},
                            {"blackman-harris", FilterKind::BlackmanHarris}},
                           "pixel filter: box, gauss, blackman-harris (default)");
    app.add_option("--filter-radius", o.filter_radius_px,
                   "pixels (default: box 0.5, the others 1.5)")
        ->check(CLI::Range(0.01, 16.0));
    add_choice<SamplerKind>(app, "--sampler", o.job.sampler,
                            {{"owen", SamplerKind::Owen},
                             {"sobol", SamplerKind::Sobol},
                             {"independent", SamplerKind::Independent}},
                            "owen (default), sobol, independent");
}

void add_output_options(CLI::App& app, RenderOptions& o) {
    app.add_option("-o,--output", o.outputs,
                   "picture to write: .exr, .png, .jpg; may be given more than once")
        ->required()
        ->group("Output");
    app.add_option("--exposure", o.display.exposure_ev,
                   "stops, for PNG and JPEG; EXR is always scene-linear")
        ->group("Output");
    app.add_option("--view", o.display.view, "display transform of PNG and JPEG")->group("Output");
    app.add_option("--aov", o.aovs,
                   "layers of the EXR: albedo,normal,depth,position,uv,emission,cost")
        ->group("Output");
    app.add_option("--stats", o.stats, "write counts and times to this JSON file")->group("Output");
    add_choice<ProgressStyle>(app, "--progress", o.progress,
                              {{"auto", ProgressStyle::Auto},
                               {"bar", ProgressStyle::Bar},
                               {"lines", ProgressStyle::Lines},
                               {"json", ProgressStyle::Json},
                               {"none", ProgressStyle::None}},
                              "auto (default), bar, lines, json, none");
    app.add_flag("--quiet", o.quiet, "only errors");
}

// Words that depend on each other, as values.
Rect resolve(RenderOptions& o) {
    SceneRequest& s = o.scene;
    s.size = parse_size("--size", o.size);
    if (!o.look_at.empty()) {
        const auto v = parse_numbers("--look-at", o.look_at, 6);
        s.look_at = {V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5])};
        if ((*s.look_at)[0] == (*s.look_at)[1])
            throw CLI::ValidationError("--look-at", "eye and target are the same point");
        if (s.camera) throw CLI::ValidationError("--look-at", "excludes --camera");
    }
    if (!o.sensor.empty()) s.sensor_mm = parse_sensor("--sensor", o.sensor);
    if (!o.focus.empty()) {
        s.focus = parse_focus("--focus", o.focus);
        if (!s.fstop && !s.lens_radius_m)
            throw CLI::ValidationError("--focus",
                                       "a pinhole has no focus: give --fstop or --lens-radius too");
    }
    if (!o.background.empty()) {
        const auto v = parse_numbers("--background", o.background, 3);
        if (v[0] < 0 || v[1] < 0 || v[2] < 0)
            throw CLI::ValidationError("--background", "is negative");
        s.background = Rgb(v[0], v[1], v[2]);
    }
    if (!o.time.empty()) o.job.time_limit_s = parse_duration_s("--time", o.time);
    o.job.end_sample = o.spp.value_or(o.job.time_limit_s ? kMostSamples : kDefaultSpp);
    const float usual_radius_px = o.filter == FilterKind::Box ? 0.5f : 1.5f;
    o.job.filter = Filter(o.filter, o.filter_radius_px > 0 ? o.filter_radius_px : usual_radius_px);
    o.job.timing = o.stats.has_value();
    if (o.threads == 0)
        o.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return o.crop.empty() ? Rect{0, 0, s.size.x, s.size.y} : parse_crop("--crop", o.crop, s.size);
}

void notice(const std::string& line) {
    fmt::print(stderr, "petzval: {}\n", line);
}

void report_bad_samples(const Film& film) {
    const auto first = film.first_bad();
    if (!first) return;
    notice(
        fmt::format("warning: {} samples were not finite and are left out; the first is sample {} "
                    "of pixel {},{}",
                    film.bad_count(), first->index, first->x, first->y));
}

int render_command(RenderOptions& o) {
    const Rect crop = resolve(o);
    const std::vector<Aov> aovs = o.aovs.empty() ? std::vector<Aov>{} : parse_aovs("--aov", o.aovs);
    for (const auto& output : o.outputs) check_output(output, o.display);
    if (o.stats) check_writable(*o.stats);

    RenderMonitor monitor;
    Interrupt interrupt(monitor);
    flush_denormals();
    TbbExecutor executor(o.threads);
    const auto say = [&](const std::string& line) {
        if (!o.quiet) notice(line);
    };
    const Session session = executor.inside([&] { return open_session(o.scene, say); });
    o.path.backdrop = session.backdrop;
    Film film(o.scene.size, crop, aovs);
    const PathTracer tracer(*session.scene, *session.bvh, *session.lights, o.path);

    interrupt.arm();
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start_s = process_cpu_s();
    RenderResult result;
    {
        const uint64_t pixels = static_cast<uint64_t>(crop.width()) * crop.height();
        const bool counted = o.job.end_sample < kMostSamples;
        const Progress progress(o.quiet ? ProgressStyle::None : o.progress, monitor,
                                counted ? std::optional(pixels * o.job.end_sample) : std::nullopt,
                                o.job.time_limit_s);
        result = render(tracer, *session.camera, o.job, film, executor, monitor);
    }
    RenderCost cost;
    cost.render_wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    cost.render_cpu_s = process_cpu_s() - cpu_start_s;
    cost.threads = o.threads;

    report_bad_samples(film);
    const Picture picture = develop(film, session, o.job, o.path, result.end_sample);
    if (result.stopped) {
        for (const auto& partial : write_partial(o.outputs, picture))
            notice(fmt::format("stopped: what there is, is in {}", partial.string()));
        return 130;
    }
    for (const auto& output : o.outputs) write_output(output, picture, o.display);
    if (o.stats) write_stats(*o.stats, session, result, cost, film);
    return 0;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "render a glTF scene to EXR, PNG or JPEG");
    add_scene_options(*command, *options);
    add_sampling_options(*command, *options);
    add_output_options(*command, *options);
    command->callback([options, &exit_code] { exit_code = render_command(*options); });
}

}  // namespace petzval
