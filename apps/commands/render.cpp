// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apps/cli/console.h"
#include "apps/cli/interrupt.h"
#include "apps/cli/render_options.h"
#include "apps/plan/plan.h"
#include "apps/plan/plan_wording.h"
#include "apps/setup/develop.h"
#include "apps/setup/spectral_wording.h"
#include "apps/setup/stats_file.h"
#include "integrator/executor.h"
#include "integrator/render.h"
#include "io/base/clock.h"
#include "io/base/format.h"
#include "io/image/threads.h"

namespace petzval {
namespace {

Notice notice_to_stderr(const RenderOptions& o) {
    NoticeStyle style = NoticeStyle::Text;
    if (o.progress == ProgressStyle::Json) style = NoticeStyle::Json;
    if (o.quiet) style = NoticeStyle::None;
    return [style](const std::string& text) { print_notice(style, text); };
}

void report_bad_samples(const Film& film, const Notice& notice) {
    const auto first = film.first_bad();
    if (!first) return;
    notice(
        fmt::format("warning: {} samples were not finite and are left out; the first is sample {} "
                    "of pixel {},{}",
                    film.bad_count(), first->index, first->x, first->y));
}

RenderResult render_watched(const RenderOptions& o, const PathTracer<>& tracer,
                            const Camera& camera, Film& film, TbbExecutor& executor,
                            RenderMonitor& monitor) {
    const uint64_t pixels = static_cast<uint64_t>(film.crop().width()) * film.crop().height();
    const bool counted = o.job.end_sample < kMostSamples;
    const Progress progress(o.quiet ? ProgressStyle::None : o.progress, monitor,
                            counted ? std::optional(pixels * o.job.end_sample) : std::nullopt,
                            o.job.time_limit_s);
    return render(tracer, camera, o.job, film, executor, monitor);
}

// Render setup whose open choices are made, told, and kept for the metadata.
RenderSetup set_up(const RenderOptions& o, double tolerance, TbbExecutor& executor,
                   const Notice& notice) {
    AutoSetup found = set_up_planned({o.scene, o.job, o.path, tolerance}, executor, notice);
    for (const std::string& line : lines_of(found.setup.from.spectral)) notice(line);
    if (const auto line = line_of(found.choice)) notice(*line);
    if (const std::string reason = reason_of(found.choice); !reason.empty())
        found.setup.from.metadata.emplace_back("petzval:plan",
                                               fmt::format("{}: {}", percent(tolerance), reason));
    return std::move(found.setup);
}

int render_command(RenderOptions& o) {
    RenderMonitor monitor;
    Interrupt interrupt(monitor);
    const RenderFrame frame = resolve(o);
    for (const auto& output : o.outputs) check_output(output, o.display);
    if (o.stats) check_writable(*o.stats);

    flush_denormals();
    TbbExecutor executor(o.threads);
    limit_picture_threads(o.threads);
    const Notice notice = notice_to_stderr(o);
    const RenderSetup setup = set_up(o, frame.tolerance, executor, notice);
    const PreparedScene& prepared = setup.prepared;
    o.path.visible_background = setup.view.visible_background;
    o.job.observer = setup.view.observer;
    Film film(o.scene.size, frame.crop, frame.aovs, o.scene.spectral.bins);
    const PathTracer tracer(*prepared.scene, *prepared.bvh, *prepared.lights, o.path);

    interrupt.arm();
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start_s = process_cpu_s();
    const RenderResult result =
        render_watched(o, tracer, *setup.view.camera, film, executor, monitor);
    RenderCost cost;
    cost.render_wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    cost.render_cpu_s = process_cpu_s() - cpu_start_s;
    cost.threads = o.threads;

    report_bad_samples(film, notice);
    const PictureRows picture = develop(film, setup, o.job, o.path, result.end_sample);
    if (result.stopped) {
        for (const auto& partial : write_partial(o.outputs, picture))
            notice(fmt::format("stopped: what there is, is in {}", partial.string()));
        return 130;
    }
    for (const auto& output : o.outputs) write_output(output, picture, o.display);
    if (o.stats) write_stats(*o.stats, setup, result, cost, film);
    return 0;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "render a glTF scene to EXR, PNG or JPEG");
    add_render_options(*command, *options);
    command->callback([options, &exit_code] { exit_code = render_command(*options); });
}

}  // namespace petzval
