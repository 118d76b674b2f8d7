// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_one.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/cli/display_options.h"
#include "apps/commands/render_files.h"
#include "apps/plan/plan.h"
#include "apps/plan/plan_wording.h"
#include "apps/setup/develop.h"
#include "apps/setup/exposure.h"
#include "apps/setup/spectral_wording.h"
#include "apps/setup/stats_file.h"
#include "apps/state/keeper.h"
#include "apps/state/run_record.h"
#include "integrator/executor.h"
#include "integrator/render.h"
#include "io/base/clock.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/image/picture_files.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

/// One render, step by step.
class OneRender {
  public:
    OneRender(RenderOptions& o, const std::vector<std::string>& command, const Notice& notice,
              Session& session)
        : o_(o), notice_(notice), session_(session), frame_(resolve(o)) {
        record_.command = command;
        std::error_code error;
        record_.folder = fs::current_path(error);
        check_outputs(o_, frame_.crop);
        shape_ = {o_.scene.size, frame_.crop, frame_.aovs, o_.scene.spectral.bins};
        samples_ = {o_.job.first_sample, o_.job.end_sample};
    }
    int run(SequencePlace&);

  private:
    void set_up(TbbExecutor&, Progress&, const RenderSetup* like);
    void choose_exposure(TbbExecutor&);
    void take_up_state();
    [[nodiscard]] bool is_there() const;
    [[nodiscard]] RenderResult render(TbbExecutor&, Progress&);
    void write_state_now(const fs::path&, const RunFigures& now, SampleRange) const;
    [[nodiscard]] int write_all(const RenderResult&, TbbExecutor&, Progress&, const SequencePlace&);
    void remove_unfinished() const;
    void show_existing(const SequencePlace&) const;
    void advise_exposure(TbbExecutor&);
    void tell_bad_samples() const;
    [[nodiscard]] RunReport report_of(const Progress&, std::vector<WriteOutcome>,
                                      bool stopped) const;
    [[nodiscard]] std::vector<std::string> found_words() const;
    [[nodiscard]] RunFigures figures_now(const PathStats&, int workers) const;
    [[nodiscard]] ProgressGoal goal(std::pair<int, int> part_of) const;

    RenderOptions& o_;
    const Notice& notice_;
    Session& session_;
    RenderFrame frame_;
    FilmShape shape_;
    SampleRange samples_;
    RunRecord record_;  ///< figures: of the runs before
    RenderSetup setup_;
    std::unique_ptr<NextFrame> next_;
    std::optional<Film> film_;
    bool goes_on_ = false;  ///< from the samples of a state
    double render_start_s_ = 0, render_start_cpu_s_ = 0;
};

ProgressGoal OneRender::goal(std::pair<int, int> part_of) const {
    const uint64_t pixels =
        static_cast<uint64_t>(frame_.crop.width()) * static_cast<uint64_t>(frame_.crop.height());
    ProgressGoal goal{pixels * o_.job.replicates, {}, o_.job.time_limit_s};
    if (o_.job.end_sample < kMostSamples || !o_.job.time_limit_s)
        goal.total = pixels * samples_.count();
    goal.part_of = part_of;
    return goal;
}

// Makes the choices that are open, tells them, and keeps them for the metadata.
void OneRender::set_up(TbbExecutor& executor, Progress& progress, const RenderSetup* like) {
    AutoSetup found =
        set_up_planned({o_.scene, o_.job, o_.path, frame_.tolerance, true, like}, executor, notice_,
                       [&](Phase phase) { progress.begin(phase); });
    for (const std::string& line : lines_of(found.setup.from.spectral)) notice_(line);
    if (const auto line = line_of(found.choice)) notice_(*line);
    if (const std::string reason = reason_of(found.choice); !reason.empty())
        found.setup.from.metadata.emplace_back(
            "petzval:plan", fmt::format("{}: {}", percent(frame_.tolerance), reason));
    setup_ = std::move(found.setup);
    o_.path.visible_background = setup_.view.visible_background;
    o_.job.observer = setup_.view.observer;
}

// Finds the exposure where it is asked for, and tells it.
void OneRender::choose_exposure(TbbExecutor& executor) {
    if (o_.auto_exposure) {
        const FoundExposure found = find_exposure(setup_, o_.job, o_.path, executor);
        o_.display.exposure_ev = found.ev;
        notice_(fmt::format("exposure: {0} EV (--exposure {0}){1}", found.ev,
                            found.log_average > 0 ? "" : ", as no light was found"));
    }
    setup_.from.exposure_ev = o_.display.exposure_ev;
    setup_.from.exposure_is_auto = o_.auto_exposure;
}

// Takes up the samples of a state of this very render, where that is asked for.
void OneRender::take_up_state() {
    const bool goes_on = o_.keep.resumed_from.has_value();
    const auto& file = goes_on ? o_.keep.resumed_from : o_.keep.state;
    std::error_code error;
    if (!file || !fs::exists(*file, error)) return;
    if (!goes_on && !o_.keep.skip_existing) {
        if (!o_.keep.state_is_wanted)
            notice_(
                fmt::format("warning: {0} is there from a render before, and will be replaced; "
                            "petzval resume {0} would go on with that one",
                            file->string()));
        return;
    }
    try {
        StateReader reader(*file);
        const StateHeader& header = reader.header();
        const RunRecord before = record_in(header, *file);
        const auto differs = difference(before.facts, header.shape, "the state", record_.facts,
                                        shape_, "what it would be now");
        if (differs || header.samples != samples_ || header.shape.crop != shape_.crop)
            throw InputError(file->string(), "",
                             differs ? "does not go on: something has changed: " + *differs
                                     : "is of other samples or another crop");
        Film film = shape_.empty_film();
        reader.add_to(film);
        film_ = std::move(film);
        goes_on_ = true;
        record_.figures = before.figures;
        notice_(fmt::format("goes on with {}, which has {} of the samples", file->string(),
                            share_text(header)));
    } catch (const InputError& refused) {
        if (goes_on) throw;
        notice_(fmt::format("warning: {}; it will be replaced", refused.what()));
    }
}

bool OneRender::is_there() const {
    if (!o_.keep.skip_existing) return false;
    if (o_.outputs.empty() && !o_.keep.state) return false;
    if (o_.keep.state_is_wanted && !(film_ && least_taken(*film_) == samples_.count()))
        return false;
    return std::all_of(o_.outputs.begin(), o_.outputs.end(), [&](const fs::path& output) {
        return is_up_to_date(output, record_.facts, shape_, samples_);
    });
}

RunFigures OneRender::figures_now(const PathStats& stats, int workers) const {
    return {stats,
            setup_.from.load_s,
            setup_.from.bvh_s,
            steady_s() - render_start_s_,
            process_cpu_s() - render_start_cpu_s_,
            o_.threads,
            workers,
            peak_memory_mib()};
}

void OneRender::write_state_now(const fs::path& to, const RunFigures& now,
                                SampleRange samples) const {
    RunRecord record = record_;
    record.figures += now;
    write_state(to, header_of(record, shape_, samples), *film_);
}

RenderResult OneRender::render(TbbExecutor& executor, Progress& progress) {
    const PreparedScene& prepared = setup_.prepared;
    const PathTracer tracer(*prepared.scene, *prepared.bvh, *prepared.lights, o_.path);
    RenderMonitor& monitor = session_.interrupt.monitor();
    session_.interrupt.arm();
    render_start_s_ = steady_s();
    render_start_cpu_s_ = process_cpu_s();
    RenderJob job = o_.job;
    if (job.time_limit_s) *job.time_limit_s -= record_.figures.render_wall_s;
    Keeper keeper({checkpoint_interval_s(o_.keep, shape_.bytes()),
                   [&](const PathStats& stats) {
                       write_state_now(*o_.keep.state, figures_now(stats, executor.threads()),
                                       samples_);
                   },
                   o_.keep.preview, o_.display, notice_},
                  monitor, *film_);
    job.at_pause = [&](const PathStats& stats) { keeper.at_pause(stats); };
    progress.begin(Phase::Rendering);
    const RenderResult result =
        petzval::render(tracer, *setup_.view.camera, job, *film_, executor, monitor);
    keeper.finish();
    progress.end_rendering(!result.stopped);
    return result;
}

void OneRender::tell_bad_samples() const {
    if (const auto first = film_->first_bad())
        notice_(
            fmt::format("warning: {} samples were not finite and are left out; the first is "
                        "sample {} of pixel {},{}",
                        film_->bad_count(), first->index, first->x, first->y));
}

// Tells what to type where PNG and JPEG show nothing.
void OneRender::advise_exposure(TbbExecutor& executor) {
    const auto displayed = [](const auto& path) {
        return picture_format(path) != PictureFormat::Exr;
    };
    if (std::none_of(o_.outputs.begin(), o_.outputs.end(), displayed)) return;
    const Brightness brightness = brightness_of(*film_, o_.display.exposure_ev);
    if (brightness == Brightness::Normal) return;
    const FoundExposure found = find_exposure(setup_, o_.job, o_.path, executor);
    if (const auto advice = exposure_advice(brightness, found, o_.display.exposure_ev))
        notice_(*advice);
}

RunReport OneRender::report_of(const Progress& progress, std::vector<WriteOutcome> outputs,
                               bool stopped) const {
    RunReport report;
    if (stopped) report.stopped_by = session_.interrupt.signal_name();
    const PhaseTimes times = progress.times();
    for (size_t i = 0; i < times.size(); ++i) report.phase_s.emplace_back(kPhaseNames[i], times[i]);
    report.outputs = std::move(outputs);
    Messages said = session_.console.messages();
    report.notices = std::move(said.notices);
    report.warnings = std::move(said.warnings);
    report.errors = std::move(said.errors);
    return report;
}

// Writes the state where one is to stay, then pictures and statistics; the exit code.
int OneRender::write_all(const RenderResult& result, TbbExecutor& executor, Progress& progress,
                         const SequencePlace& place) {
    const bool stopped = result.stopped;
    progress.begin(Phase::Writing);
    RunFigures figures = figures_now(result.stats, result.workers);
    std::vector<WriteOutcome> outcomes;
    const auto state = o_.keep.state;
    const SampleRange taken{samples_.first, result.end_sample};
    if (state && (stopped || o_.keep.state_is_wanted)) {
        const SampleRange wanted = stopped ? samples_ : taken;
        outcomes.push_back(write_or_rescue(
            *state, [&](const fs::path& to) { write_state_now(to, figures, wanted); }));
        if (!outcomes.back().written())
            session_.console.error(outcomes.back().message());
        else if (stopped)
            notice_(fmt::format("stopped: petzval resume {} goes on", state->string()));
    }
    const FinishedFilm done{*film_, taken, record_.facts};
    for (WriteOutcome& one :
         write_pictures(o_.outputs, o_.display, done, stopped, session_.console))
        outcomes.push_back(std::move(one));
    bool written = std::all_of(outcomes.begin(), outcomes.end(),
                               [](const WriteOutcome& one) { return one.written(); });
    // Only where the pictures are there: else the state is all that is left.
    if (!stopped && written) remove_unfinished();
    if (!stopped && place.show)
        place.show(
            to_display(develop(*film_, taken, record_.facts.metadata), o_.display.exposure_ev,
                       o_.display.view, AlphaUse::Keep, o_.display.config),
            o_.display);
    if (!stopped) advise_exposure(executor);
    if (o_.stats) {
        figures += record_.figures;
        const StatsPicture picture{o_.scene.size.x, o_.scene.size.y, taken, setup_.from.exposure_ev,
                                   film_->bad_count()};
        const RunReport report = report_of(progress, std::move(outcomes), stopped);
        const WriteOutcome stats = write_or_rescue(
            *o_.stats, [&](const fs::path& to) { write_stats(to, picture, figures, report); });
        if (!stats.written()) session_.console.error(stats.message());
        written = written && stats.written();
    }
    if (!written) return kOutputFailed;
    return stopped ? kStopped : kSuccess;
}

// Removes what runs before left of a render that is complete now.
void OneRender::remove_unfinished() const {
    std::error_code error;
    if (o_.keep.state && !o_.keep.state_is_wanted) fs::remove(*o_.keep.state, error);
    if (!goes_on_) return;
    for (const fs::path& output : o_.outputs) fs::remove(partial_name(output), error);
}

// Shows a picture that is there, as a display or as light.
void OneRender::show_existing(const SequencePlace& place) const {
    const auto is_exr = [](const fs::path& path) {
        return picture_format(path) == PictureFormat::Exr;
    };
    const auto shown = std::find_if_not(o_.outputs.begin(), o_.outputs.end(), is_exr);
    const Picture there = read_picture(shown == o_.outputs.end() ? o_.outputs.front() : *shown);
    if (there.for_display)
        place.show(as_display(there), o_.display);
    else
        place.show(to_display(there, o_.display.exposure_ev, o_.display.view, AlphaUse::Keep,
                              o_.display.config),
                   o_.display);
}

// What fixes the choices of this render for others: else the view, the focus and the brightness
// would jump from picture to picture.
std::vector<std::string> OneRender::found_words() const {
    std::vector<std::string> words;
    const CameraReport& camera = setup_.from.camera;
    if (setup_.prepared.cameras->empty() && !o_.scene.camera.look_at)
        words.insert(words.end(), {"--look-at", fmt::format("{},{}", with_commas(camera.eye),
                                                            with_commas(camera.target))});
    if (o_.scene.camera.orbit_deg && !o_.scene.camera.orbit_about)
        words.insert(words.end(), {"--orbit-about", with_commas(camera.orbit_about)});
    const bool has_focus = camera.lens_radius_m > 0 && camera.focus_m > 0;
    if (has_focus && (o_.camera.focus.empty() || o_.camera.focus == "auto"))
        words.insert(words.end(), {"--focus", fmt::format("{}", camera.focus_m)});
    if (o_.auto_exposure)
        words.insert(words.end(), {"--exposure", fmt::format("{}", setup_.from.exposure_ev)});
    return words;
}

int OneRender::run(SequencePlace& place) {
    flush_denormals();
    TbbExecutor executor(o_.threads);
    limit_picture_threads(o_.threads);
    for (const std::string& remark : frame_.remarks) notice_(remark);
    Progress progress(o_.quiet ? ProgressStyle::None : o_.progress, session_.console,
                      session_.interrupt.monitor(), goal(place.part_of));
    set_up(executor, progress, place.before && *place.before ? &**place.before : nullptr);
    load_image_codec();  // before hours of work: a picture will be written
    choose_exposure(executor);
    if (std::ranges::find(frame_.aovs, Aov::Velocity) != frame_.aovs.end()) {
        next_ = set_up_velocity(setup_, o_.reading.time.fps);
        o_.job.velocity = next_->velocity.get();
    }
    record_.facts = facts_of(setup_, o_.job, o_.path, o_.display, input_files(o_.display));
    record_.display = o_.display;
    if (auto& config = record_.display.config; !config.empty()) config = fs::absolute(config);
    place.found = found_words();
    take_up_state();
    int code = kSuccess;
    if (is_there()) {
        for (const fs::path& output : o_.outputs)
            notice_(fmt::format("{} is there already", output.string()));
        if (place.show && !o_.outputs.empty()) show_existing(place);
    } else {
        if (!film_) film_ = shape_.empty_film();
        uint64_t before = 0;
        for (int y = frame_.crop.y0; y < frame_.crop.y1; ++y)
            for (int x = frame_.crop.x0; x < frame_.crop.x1; ++x)
                before += film_->taken_count(x, y);
        session_.interrupt.monitor().pixel_samples_done = before;
        progress.set_before(before);
        const RenderResult result = render(executor, progress);
        tell_bad_samples();
        code = write_all(result, executor, progress, place);
    }
    next_.reset();
    if (o_.scene.reuse)
        give_back(*o_.scene.reuse, std::move(setup_.prepared));
    else if (place.before)
        *place.before = std::move(setup_);
    return code;
}

}  // namespace

int render_one(RenderOptions& o, const std::vector<std::string>& command, const Notice& notice,
               Session& session, SequencePlace& place) {
    return OneRender(o, command, notice, session).run(place);
}

}  // namespace petzval
