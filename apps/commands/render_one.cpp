// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_one.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/cli/progress.h"
#include "apps/commands/kept_state.h"
#include "apps/commands/render_files.h"
#include "apps/plan/plan_wording.h"
#include "apps/setup/develop.h"
#include "apps/setup/exposure.h"
#include "apps/setup/input_files.h"
#include "apps/setup/stats_file.h"
#include "apps/state/keeper.h"
#include "io/base/clock.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/base/printable.h"
#include "io/file/read_file.h"
#include "io/image/display.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

/// One render, step by step.
class OneRender {
  public:
    OneRender(const RenderOrder& order, const std::optional<fs::path>& resumed_from,
              const io::Notice& notice, Session& session)
        : order_(order),
          notice_(notice),
          session_(session),
          job_(job_of(order.render)),
          kept_(order, checked_files(order), resumed_from) {
        session_.console.forget_messages();  // of the pictures before
        remarks_ = settle_display(order_, kept_.files());
        shape_ = shape_of(order.render);
        check_outputs(order_, kept_.files());
        samples_ = {job_.first_sample, job_.end_sample};
    }
    int run(SequencePlace&);

  private:
    [[nodiscard]] static RenderFiles checked_files(const RenderOrder&);
    [[nodiscard]] const RenderSetup& setup() const { return render_->setup(); }
    [[nodiscard]] const io::DisplayOptions& display() const { return render_->display(); }
    [[nodiscard]] const std::vector<fs::path>& pictures() const { return kept_.files().pictures; }
    [[nodiscard]] const std::optional<fs::path>& state() const { return kept_.files().state; }
    [[nodiscard]] bool is_complete(const Film&) const;
    [[nodiscard]] bool is_there(const std::optional<Film>&) const;
    [[nodiscard]] integrator::RenderResult render(Progress&);
    [[nodiscard]] int write_all(const integrator::RenderResult&, Progress&, const SequencePlace&);
    void write_state(const integrator::RenderResult&, const RunFigures&,
                     std::vector<io::WriteOutcome>&);
    [[nodiscard]] bool write_statistics(RunFigures, SampleRange, const RunReport&);
    void show(const io::PictureRows& light, const SequencePlace&) const;
    void show_existing(const SequencePlace&) const;
    void advise_exposure();
    [[nodiscard]] RunReport report_of(const Progress&, std::vector<io::WriteOutcome>,
                                      bool stopped) const;
    [[nodiscard]] FoundChoices found() const;
    [[nodiscard]] RunFigures figures_now(const integrator::PathStats&, int workers) const;
    [[nodiscard]] ProgressGoal goal(std::pair<int, int> part_of) const;

    RenderOrder order_;
    const io::Notice& notice_;
    Session& session_;
    integrator::RenderJob job_;
    KeptState kept_;
    std::vector<std::string> remarks_;
    io::FilmShape shape_;
    SampleRange samples_;
    RenderSession* render_ = nullptr;
    double render_start_s_ = 0, render_start_cpu_s_ = 0;
};

RenderFiles OneRender::checked_files(const RenderOrder& order) {
    check(order);
    return files_of(order);
}

ProgressGoal OneRender::goal(std::pair<int, int> part_of) const {
    const Rect there = shape_.pixels();
    const uint64_t pixels =
        static_cast<uint64_t>(there.width()) * static_cast<uint64_t>(there.height());
    ProgressGoal goal{pixels * job_.replicates, {}, job_.time_limit_s};
    if (job_.end_sample < kMostSamples || !job_.time_limit_s)
        goal.total = pixels * samples_.count();
    goal.part_of = part_of;
    return goal;
}

// Whether a film that was taken up lacks no samples.
bool OneRender::is_complete(const Film& film) const {
    if (const auto reached = render_->noise(film)) return reached->open == 0;
    return film.taken_range().least == samples_.count();
}

bool OneRender::is_there(const std::optional<Film>& film) const {
    if (!order_.run.skip_existing) return false;
    if (pictures().empty() && !state()) return false;
    if (kept_.files().state_stays && !(film && is_complete(*film))) return false;
    std::optional<SampleRange> wanted = samples_;
    if (job_.time_limit_s || job_.denoised_error) wanted.reset();
    return std::ranges::all_of(pictures(), [&](const fs::path& output) {
        return is_up_to_date(output, kept_.record().facts, shape_, wanted);
    });
}

RunFigures OneRender::figures_now(const integrator::PathStats& stats, int workers) const {
    return {stats,
            setup().from.load_s,
            setup().from.bvh_s,
            integrator::steady_s() - render_start_s_,
            io::process_cpu_s() - render_start_cpu_s_,
            render_->threads(),
            workers,
            peak_memory_mib()};
}

integrator::RenderResult OneRender::render(Progress& progress) {
    integrator::RenderMonitor& monitor = session_.interrupt.monitor();
    session_.interrupt.arm();
    render_start_s_ = integrator::steady_s();
    render_start_cpu_s_ = io::process_cpu_s();
    const Film& film = render_->film();
    const RunRequest& run = order_.run;
    Keeper keeper({checkpoint_interval_s(run.checkpoint, kept_.files(), shape_.bytes()),
                   [&](const integrator::PathStats& stats) {
                       kept_.write(*state(), film, figures_now(stats, render_->threads()),
                                   samples_);
                   },
                   run.preview, [&] { return render_->look(monitor); }, display(), notice_},
                  monitor);
    progress.begin(Phase::Rendering);
    bool rendering = true;
    const auto next_phase = [&](Phase phase) {
        progress.end_rendering(true);
        rendering = false;
        progress.begin(phase);
    };
    const bool is_part = order_.render.samples.range && pictures().empty();
    const integrator::RenderResult result = render_->render(
        monitor,
        {[&](const integrator::PathStats& stats) { keeper.at_pause(stats); },
         kept_.record().figures.render_wall_s, run.stats.has_value(), next_phase, !is_part});
    keeper.finish();
    if (rendering) progress.end_rendering(!result.stopped);
    return result;
}

// Tells what to type where PNG and JPEG show nothing.
void OneRender::advise_exposure() {
    if (std::ranges::none_of(pictures(), is_for_display)) return;
    const Brightness brightness = brightness_of(render_->film(), display().exposure_ev);
    if (brightness == Brightness::Normal) return;
    const FoundExposure found = render_->find_exposure();
    if (const auto advice = exposure_advice(brightness, found, display().exposure_ev,
                                            setup().prepared.lamp_unit_doubt))
        notice_(*advice);
}

RunReport OneRender::report_of(const Progress& progress, std::vector<io::WriteOutcome> outputs,
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
void OneRender::write_state(const integrator::RenderResult& result, const RunFigures& figures,
                            std::vector<io::WriteOutcome>& outcomes) {
    const auto& state = kept_.files().state;
    if (!state || !(result.stopped || kept_.files().state_stays)) return;
    const bool partial = result.stopped || render_->film().keeps().blocks || job_.denoised_error;
    const SampleRange wanted{samples_.first, partial ? samples_.end : result.end_sample};
    const io::WriteOutcome& one =
        outcomes.emplace_back(io::write_or_rescue(*state, [&](const fs::path& to) {
            kept_.write(to, render_->film(), figures, wanted, !result.stopped);
        }));
    if (!one.written()) session_.console.error(one.message());
    const fs::path& there = one.written() ? *state : one.rescue;
    if (result.stopped && !there.empty())
        notice_(fmt::format("stopped: petzval resume {} goes on", io::for_shell(there.string())));
}

// Writes the statistics of this run and those before it; whether that was possible.
bool OneRender::write_statistics(RunFigures figures, SampleRange taken, const RunReport& report) {
    figures += kept_.record().figures;
    const StatsPicture picture{
        shape_.full_size.x,       shape_.full_size.y,         taken,
        setup().from.exposure_ev, render_->film().left_out(), render_->noise(render_->film()),
        render_->denoised()};
    const io::WriteOutcome stats = io::write_or_rescue(
        *order_.run.stats, [&](const fs::path& to) { write_stats(to, picture, figures, report); });
    if (!stats.written()) session_.console.error(stats.message());
    return stats.written();
}

// Writes the state, then pictures and statistics; the exit code.
int OneRender::write_all(const integrator::RenderResult& result, Progress& progress,
                         const SequencePlace& place) {
    const bool stopped = result.stopped;
    progress.begin(Phase::Writing);
    const RunFigures figures = figures_now(result.stats, result.workers);
    std::vector<io::WriteOutcome> outcomes;
    write_state(result, figures, outcomes);
    const SampleRange taken{samples_.first, result.end_sample};
    const std::optional<integrator::NoiseReport> noise = render_->noise(render_->film());
    const FinishedFilm done{render_->film(), noise ? samples_ : taken, kept_.record().facts, noise,
                            render_->denoised()};
    if (noise) notice_(text_of(*noise, *order_.render.samples.noise));
    if (const auto& denoised = render_->denoised()) notice_(text_of(*denoised));
    for (io::WriteOutcome& one :
         write_pictures(pictures(), display(), done, stopped, session_.console))
        outcomes.push_back(std::move(one));
    bool written = std::all_of(outcomes.begin(), outcomes.end(),
                               [](const io::WriteOutcome& one) { return one.written(); });
    // Else the state is all that is left.
    if (!stopped && written) kept_.remove_unfinished(pictures());
    if (!stopped && place.show) place.show(render_->shown(), display());
    if (!stopped) advise_exposure();
    if (order_.run.stats)
        written =
            write_statistics(figures, taken, report_of(progress, std::move(outcomes), stopped)) &&
            written;
    if (!written) return kOutputFailed;
    if (stopped) return kStopped;
    const bool left = noise && noise->left > 0;
    const bool error_left =
        job_.denoised_error && render_->denoised()->error.most() > *job_.denoised_error;
    return left || error_left ? kNoiseLeft : kSuccess;
}

// Shows a picture of light through the view that was asked for.
void OneRender::show(const io::PictureRows& light, const SequencePlace& place) const {
    const io::DisplayOptions& d = display();
    place.show(io::to_display(light, d.exposure_ev, d.view, io::AlphaUse::Keep, d.config), d);
}

// Shows a picture that is there, as a display or as light.
void OneRender::show_existing(const SequencePlace& place) const {
    const auto shown = std::ranges::find_if(pictures(), is_for_display);
    const io::Picture there =
        io::read_picture(shown == pictures().end() ? pictures().front() : *shown);
    if (there.for_display)
        place.show(io::as_display(there), display());
    else
        show(there, place);
}

FoundChoices OneRender::found() const {
    FoundChoices found;
    const CameraRequest& asked = order_.render.scene.camera;
    const CameraReport& camera = setup().from.camera;
    if (setup().prepared.cameras->empty() && !asked.look_at && !asked.pose)
        found.look_at = {camera.eye, camera.target};
    if (asked.orbit_deg && !asked.orbit_about) found.orbit_about = camera.orbit_about;
    const bool is_open = !asked.focus || std::holds_alternative<FocusAuto>(*asked.focus);
    if (is_open && camera.lens_radius_m > 0 && camera.focus_m > 0)
        found.focus = FocusDistance{camera.focus_m};
    if (setup().from.exposure_is_auto) found.exposure_ev = setup().from.exposure_ev;
    return found;
}

int OneRender::run(SequencePlace& place) {
    for (const std::string& remark : remarks_) notice_(remark);
    Progress progress(order_.run.quiet ? ProgressStyle::None : order_.run.progress,
                      session_.console, session_.interrupt.monitor(), goal(place.part_of));
    if (const int threads = threads_of(order_.run);
        !place.render || place.render->threads() != threads) {
        place.render.reset();
        place.render = std::make_unique<RenderSession>(threads, place.frames);
    }
    render_ = place.render.get();
    render_->prepare(order_.render, notice_, [&](Phase phase) { progress.begin(phase); });
    kept_.set(shape_, samples_, render_->facts(), display());
    place.found = found();
    if (session_.interrupt.monitor().stop) return kStopped;  // nothing of it is there yet
    const bool shown = kept_.files().state_stays || std::ranges::any_of(pictures(), is_for_display);
    std::optional<Film> film = kept_.take_up(shown ? Compare::Pictures : Compare::Samples, notice_);
    if (is_there(film)) {
        for (const fs::path& output : pictures())
            notice_(fmt::format("{} is there already", output.string()));
        progress.skip();
        if (place.show && !pictures().empty()) show_existing(place);
        return kSuccess;
    }
    if (film) render_->take_up(std::move(*film));
    const uint64_t before = render_->film().taken_count();
    session_.interrupt.monitor().pixel_samples_done = before;
    progress.set_before(before, kept_.record().figures.render_wall_s);
    const integrator::RenderResult result = render(progress);
    if (const auto told = left_out_text(render_->film())) notice_(*told);
    return write_all(result, progress, place);
}

}  // namespace

int render_one(const RenderOrder& order, const std::optional<fs::path>& resumed_from,
               const io::Notice& notice, Session& session, SequencePlace& place) {
    return OneRender(order, resumed_from, notice, session).run(place);
}

}  // namespace petzval::apps
