// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>

#include "apps/cli/choice.h"
#include "apps/cli/display_options.h"
#include "apps/cli/output_checks.h"
#include "apps/cli/parse.h"
#include "apps/setup/memory.h"
#include "io/base/error.h"
#include "io/picture/picture_kind.h"

namespace petzval {
namespace {

constexpr uint32_t kDefaultSpp = 64;

constexpr double kMost = 1e6;  ///< keeps every product of two numbers a float

void add_scene_options(CLI::App& app, RenderOptions& o) {
    app.add_option("scene", o.scene.scene, "glTF scene, .gltf or .glb")->required();
    app.add_option("--size", o.size, "WIDTHxHEIGHT in pixels (default 1280x720)");
    app.add_option("--tolerance", o.tolerance,
                   "error that what is chosen for you may bring: 1% (default) or 0.01");
    app.add_option("--threads", o.threads, "default: one for each core that can be had")
        ->transform(whole_number_between(1, kMostThreads));
    add_reading_options(app, o.reading);
}

void add_frame_options(CLI::App& app, RenderOptions& o) {
    app.add_option("--crop", o.crop, "x,y,width,height: only these pixels of the full frame");
    app.add_option("--spp", o.spp, "samples of each pixel (default 64)")
        ->transform(whole_number_between(1, kMostSamples));
    app.add_option("--samples", o.samples,
                   "render only the samples A:B of each pixel, and keep their sums in NAME.state, "
                   "for petzval merge")
        ->excludes(app.get_option("--spp"));
    app.add_option("--time", o.time,
                   "render for this long: 60s, 10m, 1h30m, 1:30; with --spp whichever ends first")
        ->excludes(app.get_option("--samples"));
    app.add_option("--seed", o.job.seed, "another seed, another noise")
        ->transform(whole_number_between(0, std::numeric_limits<uint32_t>::max()));
}

void add_sampling_options(CLI::App& app, RenderOptions& o) {
    app.add_option("--max-depth", o.path.max_depth,
                   "scatterings of a path, without those at clear glass (default 16)")
        ->transform(whole_number_between(0, 10000));
    app.add_option("--max-clear-depth", o.path.max_clear_depth,
                   "reflections and refractions of a path at clear glass (default 256)")
        ->transform(whole_number_between(0, 100000));
    add_choice<FilterKind>(app, "--filter", o.filter,
                           "pixel filter: box, gauss, blackman-harris (default)");
    app.add_option("--filter-radius", o.filter_radius_px,
                   "pixels (default: box 0.5, the others 1.5)")
        ->transform(number_between(0.01, 16.0, kPixels));
    add_choice<SamplerKind>(app, "--sampler", o.job.sampler, "owen (default), sobol, independent");
    add_choice<LightChoiceKind>(
        app, "--light-choice", o.scene.light_choice,
        "how one of many lights is chosen: tree (default; power, distance and direction), power, "
        "uniform");
    add_choice<TargetUse>(app, "--targets", o.scene.targets,
                          "camera rays to small lamps and highlights out of focus: auto (default; "
                          "where they pay), off");
    app.add_option("--clamp", o.job.clamp_nits,
                   "largest R, G or B of a sample, in nits: takes fireflies, and light with them")
        ->transform(number_between(1e-9, 1e12));
    add_choice<Traversal>(app, "--traversal", o.scene.traversal,
                          "robust (default): watertight; fast: may leak at edges");
}

void add_output_options(CLI::App& app, RenderOptions& o) {
    const auto add = [&](const char* name, auto& value, const char* help) {
        return app.add_option(name, value, help)->group("Output");
    };
    add("-o,--output", o.outputs,
        "picture to write: .exr, .png, .jpg; or .state; may be given more than once")
        ->required()
        ->allow_extra_args(false)  // one name each, so that the scene may follow
        ->check(complaint_about_render_name);
    o.display_only = {
        add("--exposure", o.exposure,
            "stops, for PNG and JPEG, or auto; EXR is always scene-linear (default 0)")};
    for (CLI::Option* option : add_display_options(app, o.display))
        o.display_only.push_back(option->group("Output"));
    add("--aov", o.aovs,
        "layers of the EXR: albedo,normal,depth,position,uv,emission,cost,velocity; may be given "
        "more than once")
        ->allow_extra_args(false);
    add("--stats", o.stats, "write counts and times to this JSON file");
    add_choice<ProgressStyle>(
        app, "--progress", o.progress,
        {{"auto", ProgressStyle::Auto},
         {"bar", ProgressStyle::Bar},
         {"lines", ProgressStyle::Lines},
         {"json", ProgressStyle::Json},
         {"percent", ProgressStyle::Percent},
         {"none", ProgressStyle::None}},
        "on stderr: auto (default), bar, lines, json, percent (lines as PROGRESS 37%), "
        "none");
    app.add_flag("--quiet", o.quiet, "print nothing but errors");
}

// Checks that what was asked for has an output that takes it. Returns what to tell about it.
std::vector<std::string> resolve_outputs(RenderOptions& o) {
    if (o.outputs.empty() && !o.keep.state && !o.sequence.sheet) return {};  // of a plan
    const auto is_exr = [](const auto& path) { return picture_format(path) == PictureFormat::Exr; };
    // A state that stays keeps all, and may become a PNG.
    const bool keeps = o.keep.state_is_wanted;
    const bool any_exr = keeps || std::any_of(o.outputs.begin(), o.outputs.end(), is_exr);
    const bool all_exr =
        !keeps && !o.sequence.sheet && std::all_of(o.outputs.begin(), o.outputs.end(), is_exr);
    if (o.scene.spectral.bins && !any_exr)
        throw CLI::ValidationError("--bins", "needs an output that keeps them: -o FILE.exr");
    if (!o.aovs.empty() && !any_exr)
        throw CLI::ValidationError("--aov", "needs an output that keeps layers: -o FILE.exr");
    std::string idle;
    for (const CLI::Option* option : o.display_only)
        if (all_exr && option->count() > 0) idle += (idle.empty() ? "" : ", ") + option->get_name();
    std::vector<std::string> remarks;
    if (!idle.empty())
        remarks.push_back(fmt::format(
            "warning: {}: without effect, as EXR keeps the light; add -o FILE.png, or show the "
            "EXR later by petzval image view",
            idle));
    if (!all_exr || !idle.empty())
        if (const std::string told = resolve_display(o.display); !told.empty())
            remarks.push_back(told);
    return remarks;
}

void resolve_job(RenderOptions& o) {
    if (!o.time.empty()) o.job.time_limit_s = parse_duration_s("--time", o.time);
    o.job.end_sample = o.spp.value_or(o.job.time_limit_s ? kMostSamples : kDefaultSpp);
    if (!o.samples.empty()) {
        const SampleRange samples = parse_samples("--samples", o.samples, kMostSamples);
        o.job.first_sample = samples.first;
        o.job.end_sample = samples.end;
    }
    if (o.scene.spectral.bins) {
        o.job.replicates = kReplicates;
        if (o.samples.empty() && o.job.end_sample < kReplicates)
            throw CLI::ValidationError(
                "--spp",
                fmt::format("the standard errors of --bins need at least {}", kReplicates));
    }
    const float usual_radius_px = o.filter == FilterKind::Box ? 0.5f : 1.5f;
    o.job.filter = Filter(o.filter, o.filter_radius_px > 0 ? o.filter_radius_px : usual_radius_px);
    o.job.timing = o.stats.has_value();
    if (o.threads == 0) o.threads = usual_threads();
}

void require_memory(const RenderFrame& frame, const SceneRequest& scene) {
    const double pixels = static_cast<double>(frame.crop.width()) * frame.crop.height();
    const uint64_t there_bytes =
        std::min(usable_memory_bytes(), scene.picture_memory_bytes.value_or(UINT64_MAX));
    const auto pixel_bytes =
        static_cast<double>(Film::bytes_per_pixel(frame.aovs.size(), scene.spectral.bins));
    if (const auto shortage = memory_shortage(pixels * pixel_bytes, there_bytes))
        throw OutOfMemory("--size: " + *shortage);
}

// Puts the number of a picture of a sequence into the names of its files.
void number_files(RenderOptions& o) {
    const auto number = o.sequence.number;
    if (!number) return;
    for (auto& output : o.outputs) output = name_of_frame("-o", output, *number, false);
    for (auto* file : {&o.stats, &o.keep.preview})
        if (*file) **file = name_of_frame("", **file, *number, false);
}

}  // namespace

void add_light_options(CLI::App& app, SceneRequest& s, std::string& background) {
    const auto add = [&](const char* name, auto& value, const char* help) {
        return app.add_option(name, value, help)->group("Light");
    };
    auto* env =
        add("--env", s.environment,
            "equirectangular environment picture, .hdr or .exr, or studio: the light that is "
            "built in");
    add("--env-rotate", s.environment_rotate_deg, "degrees about +y, counter-clockwise from above")
        ->transform(number_between(-kMost, kMost, kDegrees))
        ->needs(env);
    add("--env-strength", s.environment_strength, "factor on the environment")
        ->transform(number_between(0, kMost))
        ->needs(env);
    add("--background", background,
        "R,G,B in nits: a uniform environment; with --env only what the camera sees behind");
}

void resolve_background(const std::string& text, SceneRequest& scene) {
    if (text.empty()) return;
    const auto v = parse_numbers("--background", text, 3);
    if (*std::min_element(v.begin(), v.end()) < 0)
        throw CLI::ValidationError("--background", "is negative");
    scene.background = Rgb(v[0], v[1], v[2]);
}

void add_plan_options(CLI::App& app, RenderOptions& o) {
    add_scene_options(app, o);
    add_sampling_options(app, o);
    add_camera_options(app, o.camera);
    add_light_options(app, o.scene, o.background);
    app.add_flag("--transparent", o.path.transparent,
                 "the sky lights the scene but is not seen: alpha 0")
        ->group("Light");
    add_spectral_options(app, o.spectral);
}

void add_render_options(CLI::App& app, RenderOptions& o) {
    add_frame_options(app, o);
    add_plan_options(app, o);
    add_output_options(app, o);
    add_sequence_options(app, o.sequence);
    add_keep_options(app, o.keep);
}

RenderFrame resolve(RenderOptions& o) {
    number_files(o);
    SceneRequest& s = o.scene;
    s.size = parse_size("--size", o.size);
    s.picture_memory_bytes = o.reading.memory_bytes();
    s.scope = o.reading.scope();
    s.choices = o.reading.all_choices();
    resolve(o.spectral);
    s.spectral = o.spectral.request;
    s.camera = resolve(o.camera, s.size, o.reading.time);
    if (s.choices.animation) s.choices.animation->open_s = s.camera.open_s();
    resolve_job(o);
    resolve_background(o.background, s);
    o.asks_view = !o.display.view.empty();  // before resolve_display() finds the default one
    const auto exposure_ev = o.exposure ? parse_exposure_ev("--exposure", *o.exposure) : 0.f;
    o.display.exposure_ev = exposure_ev.value_or(0.f);
    o.auto_exposure = !exposure_ev;
    RenderFrame frame{{0, 0, s.size.x, s.size.y}, {}, parse_share("--tolerance", o.tolerance), {}};
    if (!o.crop.empty()) frame.crop = parse_crop("--crop", o.crop, s.size);
    if (!o.aovs.empty()) frame.aovs = parse_aovs("--aov", o.aovs);
    if (o.sequence.sheet && !o.sequence.several() && !o.sequence.number)
        throw CLI::ValidationError("--sheet", "needs --frames, --turntable or --sweep");
    if (!o.outputs.empty() || o.sequence.sheet) resolve(o.keep, o.outputs, !o.samples.empty());
    frame.remarks = resolve_outputs(o);
    require_memory(frame, s);
    return frame;
}

}  // namespace petzval
