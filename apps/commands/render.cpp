// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "apps/cli/display_options.h"
#include "apps/cli/frames.h"
#include "apps/cli/render_options.h"
#include "apps/commands/session.h"
#include "apps/plan/plan.h"
#include "apps/plan/plan_wording.h"
#include "apps/setup/develop.h"
#include "apps/setup/exposure.h"
#include "apps/setup/input_files.h"
#include "apps/setup/spectral_wording.h"
#include "apps/setup/stats_file.h"
#include "integrator/executor.h"
#include "integrator/render.h"
#include "io/base/clock.h"
#include "io/base/format.h"
#include "io/base/rescue.h"
#include "io/image/picture_files.h"

namespace petzval {
namespace {

/// Refuses what could not be written after hours, and what would destroy a file that is read.
void check_outputs(RenderOptions& o, const Rect& crop) {
    std::vector<NamedFile>& outputs = o.scene.outputs;
    std::vector<std::filesystem::path> partials;
    for (const auto& output : o.outputs) {
        outputs.push_back({"-o", output});
        const auto partial = partial_name(output);  // which the formats of a name share
        const auto same = [&](const auto& other) { return same_file(other, partial); };
        if (std::none_of(partials.begin(), partials.end(), same)) partials.push_back(partial);
    }
    if (o.stats) outputs.push_back({"--stats", *o.stats});
    for (const auto& partial : partials)
        outputs.push_back({"the picture of a render that is stopped", partial});
    refuse_overwriting(outputs, input_files(o.scene));
    refuse_overwriting(outputs, input_files(o.display));
    refuse_overwriting(outputs, own_files());
    for (const auto& output : o.outputs)
        check_output(output, o.display, crop.width(), crop.height());
    if (o.stats) check_writable(*o.stats);
}

void report_bad_samples(const Film& film, const Notice& notice) {
    const auto first = film.first_bad();
    if (!first) return;
    notice(
        fmt::format("warning: {} samples were not finite and are left out; the first is sample {} "
                    "of pixel {},{}",
                    film.bad_count(), first->index, first->x, first->y));
}

ProgressGoal goal_of(const RenderJob& job, const Rect& crop) {
    const uint64_t pixels = static_cast<uint64_t>(crop.width()) * crop.height();
    ProgressGoal goal{pixels * job.replicates, {}, job.time_limit_s};
    if (job.end_sample < kMostSamples || !job.time_limit_s) goal.total = pixels * job.end_sample;
    return goal;
}

// Render setup whose open choices are made, told, and kept for the metadata.
RenderSetup set_up(const RenderOptions& o, double tolerance, TbbExecutor& executor,
                   const Notice& notice, Progress& progress) {
    AutoSetup found = set_up_planned({o.scene, o.job, o.path, tolerance}, executor, notice,
                                     [&](Phase phase) { progress.begin(phase); });
    for (const std::string& line : lines_of(found.setup.from.spectral)) notice(line);
    if (const auto line = line_of(found.choice)) notice(*line);
    if (const std::string reason = reason_of(found.choice); !reason.empty())
        found.setup.from.metadata.emplace_back("petzval:plan",
                                               fmt::format("{}: {}", percent(tolerance), reason));
    return std::move(found.setup);
}

// Finds the exposure where it is asked for, and tells it.
void choose_exposure(RenderOptions& o, RenderSetup& setup, TbbExecutor& executor,
                     const Notice& notice) {
    if (o.auto_exposure) {
        const FoundExposure found = find_exposure(setup, o.job, o.path, executor);
        o.display.exposure_ev = found.ev;
        notice(fmt::format("exposure: {0} EV (--exposure {0}){1}", found.ev,
                           found.log_average > 0 ? "" : ", as no light was found"));
    }
    setup.from.exposure_ev = o.display.exposure_ev;
    setup.from.exposure_is_auto = o.auto_exposure;
}

// Tells what to type where PNG and JPEG show nothing.
void advise_exposure(const RenderOptions& o, const RenderSetup& setup, const Film& film,
                     TbbExecutor& executor, const Notice& notice) {
    const auto displayed = [](const auto& path) {
        return picture_format(path) != PictureFormat::Exr;
    };
    if (std::none_of(o.outputs.begin(), o.outputs.end(), displayed)) return;
    const Brightness brightness = brightness_of(film, o.display.exposure_ev);
    if (brightness == Brightness::Normal) return;
    const FoundExposure found = find_exposure(setup, o.job, o.path, executor);
    if (const auto advice = exposure_advice(brightness, found, o.display.exposure_ev))
        notice(*advice);
}

/// Writes all pictures, whichever of them fail; each failure is told.
std::vector<WriteOutcome> write_pictures(const RenderOptions& o, const PictureRows& picture,
                                         bool stopped, Console& console) {
    std::vector<WriteOutcome> outcomes;
    if (stopped)
        outcomes = write_partial(o.outputs, picture);
    else
        for (const auto& output : o.outputs)
            outcomes.push_back(write_or_rescue(output, [&](const std::filesystem::path& to) {
                write_output(to, picture, o.display);
            }));
    for (const WriteOutcome& one : outcomes) {
        if (!one.written())
            console.error(one.message());
        else if (stopped)
            console.notice(fmt::format("stopped: what there is, is in {}", one.wanted.string()));
    }
    return outcomes;
}

RunReport report_of(const Session& session, const Progress& progress,
                    std::vector<WriteOutcome> outputs, bool stopped) {
    RunReport report;
    if (stopped) report.stopped_by = session.interrupt.signal_name();
    const PhaseTimes times = progress.times();
    for (size_t i = 0; i < times.size(); ++i) report.phase_s.emplace_back(kPhaseNames[i], times[i]);
    report.outputs = std::move(outputs);
    Messages said = session.console.messages();
    report.notices = std::move(said.notices);
    report.warnings = std::move(said.warnings);
    report.errors = std::move(said.errors);
    return report;
}

struct Rendered {
    RenderResult result;
    RenderCost cost;
};

Rendered render_watched(const RenderOptions& o, const RenderSetup& setup, Film& film,
                        TbbExecutor& executor, Session& session, Progress& progress) {
    const PreparedScene& prepared = setup.prepared;
    const PathTracer tracer(*prepared.scene, *prepared.bvh, *prepared.lights, o.path);
    session.interrupt.arm();
    progress.begin(Phase::Rendering);
    const double start_s = steady_s(), cpu_start_s = process_cpu_s();
    Rendered out;
    out.result =
        render(tracer, *setup.view.camera, o.job, film, executor, session.interrupt.monitor());
    out.cost = {steady_s() - start_s, process_cpu_s() - cpu_start_s, o.threads};
    progress.end_rendering(!out.result.stopped);
    return out;
}

/// Writes pictures and statistics of what was rendered; the exit code.
int write_all(const RenderOptions& o, const RenderSetup& setup, const Film& film,
              const Rendered& rendered, TbbExecutor& executor, const Notice& notice,
              Session& session, Progress& progress) {
    const bool stopped = rendered.result.stopped;
    progress.begin(Phase::Writing);
    const PictureRows picture = develop(film, setup, o.job, o.path, rendered.result.end_sample);
    std::vector<WriteOutcome> outcomes = write_pictures(o, picture, stopped, session.console);
    bool written = std::all_of(outcomes.begin(), outcomes.end(),
                               [](const WriteOutcome& one) { return one.written(); });
    if (!stopped) advise_exposure(o, setup, film, executor, notice);
    if (o.stats) {
        const RunReport report = report_of(session, progress, std::move(outcomes), stopped);
        const WriteOutcome stats = write_or_rescue(*o.stats, [&](const std::filesystem::path& to) {
            write_stats(to, setup, rendered.result, rendered.cost, report, film);
        });
        if (!stats.written()) session.console.error(stats.message());
        written = written && stats.written();
    }
    if (!written) return kOutputFailed;
    return stopped ? kStopped : kSuccess;
}

/// Settings that the first frame of a sequence found, and that hold for all.
struct Found {
    CameraReport camera;
    bool framed = false;  ///< the camera, to show the scene
    float exposure_ev = 0;
};

/// Renders one picture; `found` gets what it chose. The exit code.
int render_one(RenderOptions& o, const Notice& notice, Session& session, Found& found) {
    const RenderFrame frame = resolve(o);
    check_outputs(o, frame.crop);

    flush_denormals();
    TbbExecutor executor(o.threads);
    limit_picture_threads(o.threads);
    for (const std::string& remark : frame.remarks) notice(remark);
    Progress progress(o.quiet ? ProgressStyle::None : o.progress, session.console,
                      session.interrupt.monitor(), goal_of(o.job, frame.crop));
    RenderSetup setup = set_up(o, frame.tolerance, executor, notice, progress);
    load_image_codec();  // before hours of work: a picture will be written
    choose_exposure(o, setup, executor, notice);
    o.path.visible_background = setup.view.visible_background;
    o.job.observer = setup.view.observer;
    std::unique_ptr<NextFrame> next;
    if (std::ranges::find(frame.aovs, Aov::Velocity) != frame.aovs.end()) {
        next = set_up_velocity(setup, o.reading.time.fps);
        o.job.velocity = next->velocity.get();
    }
    Film film(o.scene.size, frame.crop, frame.aovs, o.scene.spectral.bins);
    const Rendered rendered = render_watched(o, setup, film, executor, session, progress);
    report_bad_samples(film, notice);
    const int code = write_all(o, setup, film, rendered, executor, notice, session, progress);
    found = {setup.from.camera, setup.prepared.cameras->empty() && !o.scene.camera.look_at,
             setup.from.exposure_ev};
    if (o.scene.reuse) give_back(*o.scene.reuse, std::move(setup.prepared));
    return code;
}

// Makes what the first frame found hold for the others: else the view, the focus and the brightness
// would jump from frame to frame.
void hold(const Found& found, RenderOptions& o) {
    const CameraReport& camera = found.camera;
    if (found.framed)
        o.camera.look_at =
            fmt::format("{},{}", with_commas(camera.eye), with_commas(camera.target));
    const bool has_focus = camera.lens_radius_m > 0 && camera.focus_m > 0;
    if (has_focus && (o.camera.focus.empty() || o.camera.focus == "auto"))
        o.camera.focus = fmt::format("{}", camera.focus_m);
    if (o.exposure == "auto") o.exposure = fmt::format("{}", found.exposure_ev);
}

/// Renders the frames of a sequence, each as --at would. The exit code is that of the first frame
/// that fails, which ends the sequence.
int render_frames(const RenderOptions& asked, const Notice& notice, Session& session) {
    const std::vector<int> frames = parse_frames("--frames", asked.frames);
    const bool several = frames.size() > 1;
    RenderOptions all = asked;
    all.scene.reuse = std::make_shared<FrameReuse>();
    std::set<std::string> said;
    const Notice once = [&](const std::string& text) {
        if (said.insert(text).second) notice(text);
    };
    for (size_t i = 0; i < frames.size(); ++i) {
        RenderOptions one = all;
        one.reading.time.at = fmt::format("frame:{}", frames[i]);
        for (auto& output : one.outputs) output = name_of_frame("-o", output, frames[i], several);
        if (one.stats) one.stats = name_of_frame("--stats", *one.stats, frames[i], several);
        if (several) notice(fmt::format("frame {}, {} of {}", frames[i], i + 1, frames.size()));
        session.interrupt.monitor().pixel_samples_done = 0;
        Found found;
        const int code = render_one(one, once, session, found);
        if (code != kSuccess) return code;
        if (i == 0) hold(found, all);
    }
    return kSuccess;
}

int render_command(RenderOptions& o, Session& session) {
    const Notice notice = [&](const std::string& text) { session.console.notice(text); };
    if (!o.frames.empty()) return render_frames(o, notice, session);
    Found found;
    return render_one(o, notice, session, found);
}

}  // namespace

void add_render_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "render a glTF scene to EXR, PNG or JPEG");
    add_render_options(*command, *options);
    command->callback(
        [options, &session] { session.exit_code = render_command(*options, session); });
}

}  // namespace petzval
