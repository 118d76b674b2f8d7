// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_one.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/cli/display_options.h"
#include "apps/commands/kept_state.h"
#include "apps/commands/render_files.h"
#include "apps/setup/develop.h"
#include "apps/setup/exposure.h"
#include "apps/setup/input_files.h"
#include "apps/setup/stats_file.h"
#include "apps/state/keeper.h"
#include "io/base/clock.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/base/printable.h"
#include "io/base/read_file.h"
#include "io/image/display.h"
#include "io/image/picture_files.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

bool is_for_display(const fs::path& picture) {
    return picture_format(picture) != PictureFormat::Exr;
}

/// One render, step by step.
class OneRender {
  public:
    OneRender(RenderOptions& o, const std::vector<std::string>& command, const Notice& notice,
              Session& session)
        : o_(o), notice_(notice), session_(session), frame_(resolve(o)), kept_(o.keep, command) {
        session_.console.forget_messages();  // of the pictures before
        check_outputs(o_, frame_.crop);
        shape_ = {o_.scene.size, frame_.crop, frame_.aovs, o_.scene.spectral.bins};
        samples_ = {o_.job.first_sample, o_.job.end_sample};
    }
    int run(SequencePlace&);

  private:
    [[nodiscard]] RenderRequest request() const;
    [[nodiscard]] const RenderSetup& setup() const { return render_->setup(); }
    [[nodiscard]] const DisplayOptions& display() const { return render_->request().display; }
    [[nodiscard]] bool is_there(const std::optional<Film>&) const;
    [[nodiscard]] RenderResult render(Progress&);
    [[nodiscard]] int write_all(const RenderResult&, Progress&, const SequencePlace&);
    void write_state(const RenderResult&, const RunFigures&, std::vector<WriteOutcome>&);
    [[nodiscard]] bool write_statistics(RunFigures, SampleRange, const RunReport&);
    void show(const PictureRows& light, const SequencePlace&) const;
    void show_existing(const SequencePlace&) const;
    void advise_exposure();
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
    KeptState kept_;
    RenderSession* render_ = nullptr;
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

RenderRequest OneRender::request() const {
    return {.scene = o_.scene,
            .crop = frame_.crop,
            .layers = frame_.aovs,
            .job = o_.job,
            .path = o_.path,
            .tolerance = frame_.tolerance,
            .fps = o_.reading.time.fps,
            .display = o_.display,
            .asks_exposure = o_.exposure.has_value(),
            .asks_view = o_.asks_view,
            .finds_exposure = o_.auto_exposure};
}

bool OneRender::is_there(const std::optional<Film>& film) const {
    if (!o_.keep.skip_existing) return false;
    if (o_.outputs.empty() && !o_.keep.state) return false;
    if (o_.keep.state_is_wanted && !(film && film->taken_range().least == samples_.count()))
        return false;
    std::optional<SampleRange> wanted = samples_;
    if (o_.job.time_limit_s) wanted.reset();
    return std::all_of(o_.outputs.begin(), o_.outputs.end(), [&](const fs::path& output) {
        return is_up_to_date(output, kept_.record().facts, shape_, wanted);
    });
}

RunFigures OneRender::figures_now(const PathStats& stats, int workers) const {
    return {stats,
            setup().from.load_s,
            setup().from.bvh_s,
            steady_s() - render_start_s_,
            process_cpu_s() - render_start_cpu_s_,
            o_.threads,
            workers,
            peak_memory_mib()};
}

RenderResult OneRender::render(Progress& progress) {
    RenderMonitor& monitor = session_.interrupt.monitor();
    session_.interrupt.arm();
    render_start_s_ = steady_s();
    render_start_cpu_s_ = process_cpu_s();
    const Film& film = render_->film();
    Keeper keeper({checkpoint_interval_s(o_.keep, shape_.bytes()),
                   [&](const PathStats& stats) {
                       kept_.write(*o_.keep.state, film, figures_now(stats, o_.threads), samples_);
                   },
                   o_.keep.preview, display(), notice_},
                  monitor, film);
    progress.begin(Phase::Rendering);
    const RenderResult result = render_->render(
        monitor, [&](const PathStats& stats) { keeper.at_pause(stats); },
        kept_.record().figures.render_wall_s);
    keeper.finish();
    progress.end_rendering(!result.stopped);
    return result;
}

// Tells what to type where PNG and JPEG show nothing.
void OneRender::advise_exposure() {
    if (std::ranges::none_of(o_.outputs, is_for_display)) return;
    const Brightness brightness = brightness_of(render_->film(), display().exposure_ev);
    if (brightness == Brightness::Normal) return;
    const FoundExposure found = render_->find_exposure();
    if (const auto advice = exposure_advice(brightness, found, display().exposure_ev,
                                            setup().prepared.lamp_unit_doubt))
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

// Writes the state where one is to stay, or the render goes on later.
void OneRender::write_state(const RenderResult& result, const RunFigures& figures,
                            std::vector<WriteOutcome>& outcomes) {
    const auto& state = o_.keep.state;
    if (!state || !(result.stopped || o_.keep.state_is_wanted)) return;
    const SampleRange wanted{samples_.first, result.stopped ? samples_.end : result.end_sample};
    const WriteOutcome& one = outcomes.emplace_back(write_or_rescue(
        *state, [&](const fs::path& to) { kept_.write(to, render_->film(), figures, wanted); }));
    if (!one.written()) session_.console.error(one.message());
    const fs::path& there = one.written() ? *state : one.rescue;
    if (result.stopped && !there.empty())
        notice_(fmt::format("stopped: petzval resume {} goes on", for_shell(there.string())));
}

// Writes the statistics of this run and those before it; whether that was possible.
bool OneRender::write_statistics(RunFigures figures, SampleRange taken, const RunReport& report) {
    figures += kept_.record().figures;
    const StatsPicture picture{o_.scene.size.x, o_.scene.size.y, taken, setup().from.exposure_ev,
                               render_->film().left_out()};
    const WriteOutcome stats = write_or_rescue(
        *o_.stats, [&](const fs::path& to) { write_stats(to, picture, figures, report); });
    if (!stats.written()) session_.console.error(stats.message());
    return stats.written();
}

// Writes the state, then pictures and statistics; the exit code.
int OneRender::write_all(const RenderResult& result, Progress& progress,
                         const SequencePlace& place) {
    const bool stopped = result.stopped;
    progress.begin(Phase::Writing);
    const RunFigures figures = figures_now(result.stats, result.workers);
    std::vector<WriteOutcome> outcomes;
    write_state(result, figures, outcomes);
    const SampleRange taken{samples_.first, result.end_sample};
    const FinishedFilm done{render_->film(), taken, kept_.record().facts};
    for (WriteOutcome& one : write_pictures(o_.outputs, display(), done, stopped, session_.console))
        outcomes.push_back(std::move(one));
    bool written = std::all_of(outcomes.begin(), outcomes.end(),
                               [](const WriteOutcome& one) { return one.written(); });
    // Else the state is all that is left.
    if (!stopped && written) kept_.remove_unfinished(o_.outputs);
    if (!stopped && place.show) show(develop(render_->film(), taken, {}), place);
    if (!stopped) advise_exposure();
    if (o_.stats)
        written =
            write_statistics(figures, taken, report_of(progress, std::move(outcomes), stopped)) &&
            written;
    if (!written) return kOutputFailed;
    return stopped ? kStopped : kSuccess;
}

// Shows light through the view that was asked for.
void OneRender::show(const PictureRows& light, const SequencePlace& place) const {
    const DisplayOptions& d = display();
    place.show(to_display(light, d.exposure_ev, d.view, AlphaUse::Keep, d.config), d);
}

// Shows a picture that is there, as a display or as light.
void OneRender::show_existing(const SequencePlace& place) const {
    const auto shown = std::ranges::find_if(o_.outputs, is_for_display);
    const Picture there = read_picture(shown == o_.outputs.end() ? o_.outputs.front() : *shown);
    if (there.for_display)
        place.show(as_display(there), display());
    else
        show(there, place);
}

// What fixes the choices of this render for others: else the view, the focus and the brightness
// would jump from picture to picture.
std::vector<std::string> OneRender::found_words() const {
    std::vector<std::string> words;
    const CameraReport& camera = setup().from.camera;
    if (setup().prepared.cameras->empty() && !o_.scene.camera.look_at)
        words.insert(words.end(), {"--look-at", fmt::format("{},{}", with_commas(camera.eye),
                                                            with_commas(camera.target))});
    if (o_.scene.camera.orbit_deg && !o_.scene.camera.orbit_about)
        words.insert(words.end(), {"--orbit-about", with_commas(camera.orbit_about)});
    const bool has_focus = camera.lens_radius_m > 0 && camera.focus_m > 0;
    if (has_focus && (o_.camera.focus.empty() || o_.camera.focus == "auto"))
        words.insert(words.end(), {"--focus", fmt::format("{}", camera.focus_m)});
    if (o_.auto_exposure)
        words.insert(words.end(), {"--exposure", fmt::format("{}", setup().from.exposure_ev)});
    return words;
}

int OneRender::run(SequencePlace& place) {
    for (const std::string& remark : frame_.remarks) notice_(remark);
    Progress progress(o_.quiet ? ProgressStyle::None : o_.progress, session_.console,
                      session_.interrupt.monitor(), goal(place.part_of));
    if (!place.render || place.render->threads() != o_.threads) {
        place.render.reset();
        place.render = std::make_unique<RenderSession>(o_.threads, place.frames);
    }
    render_ = place.render.get();
    render_->prepare(request(), notice_, [&](Phase phase) { progress.begin(phase); });
    kept_.set(shape_, samples_, render_->facts(), display());
    place.found = found_words();
    if (session_.interrupt.monitor().stop) return kStopped;  // nothing of it is there yet
    const bool shown = o_.keep.state_is_wanted || std::ranges::any_of(o_.outputs, is_for_display);
    std::optional<Film> film = kept_.take_up(shown ? Compare::Pictures : Compare::Samples, notice_);
    if (is_there(film)) {
        for (const fs::path& output : o_.outputs)
            notice_(fmt::format("{} is there already", output.string()));
        progress.skip();
        if (place.show && !o_.outputs.empty()) show_existing(place);
        return kSuccess;
    }
    if (film) render_->take_up(std::move(*film));
    const uint64_t before = render_->film().taken_count();
    session_.interrupt.monitor().pixel_samples_done = before;
    progress.set_before(before, kept_.record().figures.render_wall_s);
    const RenderResult result = render(progress);
    tell_bad_samples(render_->film(), notice_);
    return write_all(result, progress, place);
}

}  // namespace

int render_one(RenderOptions& o, const std::vector<std::string>& command, const Notice& notice,
               Session& session, SequencePlace& place) {
    return OneRender(o, command, notice, session).run(place);
}

}  // namespace petzval
