// SPDX-License-Identifier: Apache-2.0
#include "apps/render/render_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "apps/plan/noise_setup.h"
#include "apps/plan/plan_wording.h"
#include "apps/setup/develop.h"
#include "apps/setup/input_files.h"
#include "apps/setup/memory.h"
#include "apps/setup/spectral_wording.h"
#include "apps/setup/tracer.h"
#include "apps/state/finished_film.h"
#include "integrator/render/render.h"
#include "integrator/render/render_to_noise.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/base/printable.h"
#include "io/file/read_file.h"
#include "io/image/display.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

/// Files that a request names, but for pictures and the scene, which are hashed as they are read.
std::vector<std::pair<std::filesystem::path, std::string>> hashes_of_inputs(
    const SceneRequest& scene) {
    std::vector<std::pair<std::filesystem::path, std::string>> out;
    std::error_code none;
    for (const io::NamedFile& file : input_files(scene))
        if (file.path != scene.scene && file.path != scene.environment &&
            std::filesystem::is_regular_file(file.path, none))
            out.emplace_back(file.path, io::name_and_hash(file.path));
    return out;
}

/// Whether two requests are for frames of one sequence.
bool same_but_for_time(SceneRequest a, const SceneRequest& b) {
    if (a.choices.animation && b.choices.animation)
        a.choices.animation->time_s = b.choices.animation->time_s;
    return a.scene == b.scene && a.scope == b.scope && a.choices == b.choices &&
           a.environment == b.environment && a.environment_rotate_deg == b.environment_rotate_deg &&
           a.environment_strength == b.environment_strength;
}

// Makes the choices that are open, tells them, and keeps them for the metadata.
RenderSetup set_up(const PlanRequest& request, integrator::TbbExecutor& executor,
                   const io::Notice& notice, const PhaseSink& begins) {
    AutoSetup found = set_up_planned(request, executor, notice, begins);
    for (const std::string& line : lines_of(found.setup.from.spectral)) notice(line);
    if (const auto line = line_of(found.choice)) notice(*line);
    if (const std::string reason = reason_of(found.choice); !reason.empty())
        found.setup.from.metadata.emplace_back(
            "petzval:plan", fmt::format("{}: {}", io::percent(request.tolerance), reason));
    return std::move(found.setup);
}

}  // namespace

io::FilmShape shape_of(const RenderRequest& request) {
    const V2i size = request.scene.size;
    return {size,
            pixels_of(request.crop, size),
            request.layers,
            request.scene.spectral.bins,
            {request.samples.noise.has_value() && !request.denoise, request.denoise}};
}

RenderSession::RenderSession(int threads, Frames frames) : executor_(threads) {
    io::limit_picture_threads(threads);
    if (frames == Frames::Sequence) frames_.emplace();
}

void RenderSession::take(LoadedScene scene) {
    setup_ = {};
    setup_.prepared = std::move(scene.prepared);
    setup_.from.asked = std::move(scene.asked);
}

void RenderSession::prepare(const RenderRequest& asked, const io::Notice& notice,
                            const PhaseSink& begins) {
    const LoadedScene loaded = frames_ ? LoadedScene() : scene();
    if (begins) executor_.before_task([&] { begins(Phase::Planning); });  // pilots are part of it
    try {
        prepare_like(std::exchange(setup_, {}), asked, notice, begins);
    } catch (...) {
        executor_.before_task({});
        take(loaded);
        throw;
    }
    executor_.before_task({});
}

void RenderSession::prepare_like(RenderSetup before, const RenderRequest& asked,
                                 const io::Notice& notice, const PhaseSink& begins) {
    flush_denormals();
    next_.reset();
    denoised_.reset();
    std::optional<Film> film = std::exchange(film_, std::nullopt);
    const RenderFacts facts = std::exchange(facts_, {});
    const io::FilmShape shape = std::exchange(shape_, {});
    check(asked);
    shape_ = shape_of(asked);
    const uint64_t there_bytes =
        std::min(io::usable_memory_bytes(), asked.scene.picture_memory_bytes.value_or(UINT64_MAX));
    if (const auto shortage = memory_shortage(double(shape_.bytes()), there_bytes))
        throw io::OutOfMemory("⟨size⟩: " + *shortage);
    SceneRequest scene = resolved_scene(asked);
    const auto inputs = hashes_of_inputs(scene);
    const uint32_t first = job_.first_sample;
    if (frames_) before = {};  // the frame takes it apart
    if (frames_ && !same_but_for_time(scene_, scene)) frames_.emplace();
    const bool shares = before.prepared.scene != nullptr;
    request_ = asked;
    scene_ = std::move(scene);
    job_ = job_of(asked);
    path_ = asked.path;
    setup_ = set_up({scene_, job_, path_, asked.tolerance, shares ? &before : nullptr,
                     frames_ ? &*frames_ : nullptr},
                    executor_, notice, begins);
    path_.visible_background = setup_.view.visible_background;
    job_.observer = setup_.view.observer;
    io::load_image_codec();  // before hours of work: a picture will be written
    choose_display(notice);
    warn_of_lamps(notice);
    if (std::ranges::find(asked.layers, Aov::Velocity) != asked.layers.end()) {
        const double fps = asked.moment.fps;
        next_ = set_up_velocity(setup_, fps);
        job_.velocity = next_->velocity.get();
        setup_.from.metadata.emplace_back("petzval:fps", fmt::format("{}", fps));
    }
    if (asked.samples.noise && !asked.denoise)
        job_.noise =
            noise_target(setup_, job_, path_, scene_.size, *asked.samples.noise, executor_);
    facts_ = facts_of(setup_, job_, path_, display_);
    for (const auto& [file, hash] : inputs)
        if (io::name_and_hash(file) != hash)
            throw io::InputError(file.string(), "", "was changed while it was read; start again");
    const uint32_t asked_samples = job_.end_sample - job_.first_sample;
    if (film && first == job_.first_sample && film->taken_range().most <= asked_samples &&
        light_hash(facts, shape, {0, 0}) == light_hash(facts_, shape_, {0, 0}))
        film_ = std::move(film);
    else
        film_ = shape_.empty_film();
}

// What a path adds to a pixel counts from a tenth of what the display shows as white.
void RenderSession::warn_of_lamps(const io::Notice& notice) const {
    constexpr double kSeen = 0.1;
    if (job_.end_sample == kMostSamples)
        return;  // a time limit: nobody knows how many there will be
    const auto samples = static_cast<double>(job_.end_sample - job_.first_sample);
    const double nits = kSeen * std::exp2(-double(display_.exposure_ev));
    if (const auto warning = warning_of(seldom_met(setup_, scene_.size, samples, nits)))
        notice(*warning);
}

// Settles exposure and view: as asked, as the scene's file asks, or as a pilot finds; and tells it.
void RenderSession::choose_display(const io::Notice& notice) {
    const DisplayRequest& asked = request_.display;
    const io::SceneExtras& file = setup_.prepared.extras;
    display_ = {asked.exposure ? asked.exposure->ev : file.exposure_ev.value_or(0.f), asked.view,
                asked.config};
    std::string taken;
    if (file.exposure_ev && !asked.exposure)
        taken = fmt::format("exposure {} EV", *file.exposure_ev);
    if (file.view && asked.view.empty()) {
        try {
            display_.view = io::find_view(*file.view, asked.config);
        } catch (const io::InputError& error) {
            throw io::InputError(scene_.scene.string(), file.path + "/view",
                                 fmt::format("{}; ⟨view⟩ takes another", error.what()));
        }
        taken += (taken.empty() ? "view " : ", view ") + io::printable(*file.view);
    } else {
        display_.view = io::find_view(asked.view, asked.config);
    }
    if (!taken.empty())
        notice(fmt::format("the scene asks for {} (⟨exposure⟩ and ⟨view⟩ go before it)", taken));
    const bool finds = asked.exposure && asked.exposure->is_auto;
    if (finds) {
        const FoundExposure found = find_exposure();
        display_.exposure_ev = found.ev;
        notice(fmt::format("exposure: {0} EV (⟨exposure⟩ {0}){1}", found.ev,
                           found.log_average > 0 ? "" : ", as no light was found"));
    }
    setup_.from.exposure_ev = display_.exposure_ev;
    setup_.from.exposure_is_auto = finds;
}

integrator::RenderResult RenderSession::render(integrator::RenderMonitor& monitor,
                                               const RenderRun& run) {
    flush_denormals();
    const integrator::PathTracer<> tracer = tracer_of(setup_, path_);
    integrator::RenderJob job = job_;
    if (job.time_limit_s) *job.time_limit_s -= run.spent_s;
    job.at_pause = run.at_pause;
    job.timing = run.timing;
    const camera::Camera& camera = *setup_.view.camera;
    denoised_.reset();
    if (job.noise)
        return integrator::render_to_noise(tracer, camera, job, *film_, executor_, monitor);
    const auto all = [&](const integrator::RenderJob& part) {
        return integrator::render(tracer, camera, part, *film_, executor_, monitor);
    };
    if (job.denoised_error) return render_to_denoised(job, all, monitor);
    integrator::RenderResult result = all(job);
    if (run.denoises && film_->keeps().halves && !result.stopped) {
        if (run.begins) run.begins(Phase::Denoising);
        denoised_ = denoised_film(*film_, executor_, monitor.stop);
        result.stopped = !denoised_;
    }
    return result;
}

// The counts of samples are 16, 24, 32, 48 and so on, so that a stop and its resumption, and other
// times, end where one run ends.
integrator::RenderResult RenderSession::render_to_denoised(
    integrator::RenderJob job,
    const std::function<integrator::RenderResult(const integrator::RenderJob&)>& render_all,
    integrator::RenderMonitor& monitor) {
    const double start_s = job.wall_s(), target = *job.denoised_error;
    const std::optional<double> limit_s = job.time_limit_s;
    const uint32_t most = job.end_sample;
    const auto at_pause = job.at_pause;
    integrator::RenderResult all;
    if (at_pause)
        job.at_pause = [&](const integrator::PathStats& stats) {
            integrator::PathStats sum = all.stats;
            sum += stats;
            at_pause(sum);
        };
    for (uint32_t taken = film_->taken_range().most;;) {
        uint32_t next = integrator::kLeastOfCell;
        while (next < taken) next += std::bit_floor(next) / 2;
        job.end_sample = std::min(next, most);
        if (limit_s) job.time_limit_s = *limit_s - (job.wall_s() - start_s);
        const integrator::RenderResult part = render_all(job);
        all.stats += part.stats;
        all.workers = std::max(all.workers, part.workers);
        all.end_sample = part.end_sample;
        all.stopped = part.stopped;
        if (!all.stopped) denoised_ = denoised_film(*film_, executor_, monitor.stop);
        all.stopped = !denoised_;
        if (all.stopped) return all;
        const DenoisedError& error = denoised_->error;
        monitor.noise = error.most();
        const bool late = part.end_sample < job.end_sample;
        if (error.most() <= target || late || job.end_sample == most) return all;
        // As if the squared error fell with the samples.
        const double expected = std::pow(error.most() / target, 2) * job.end_sample;
        const Rect pixels = film_->pixels();
        monitor.expected_pixel_samples = static_cast<uint64_t>(std::min(expected, double(most)) *
                                                               pixels.width() * pixels.height());
        denoised_.reset();
        taken = part.end_sample + 1;
    }
}

io::Picture RenderSession::look(const integrator::RenderMonitor& monitor) {
    const bool denoises = film_->keeps().halves && !denoised_;
    const auto denoised = denoises ? denoised_film(*film_, executor_, monitor.stop) : denoised_;
    return colours_of(*film_, 4, denoised.get());
}

std::optional<integrator::NoiseReport> RenderSession::noise(const Film& film) const {
    return reached_noise(facts_, film, {job_.first_sample, job_.end_sample});
}

integrator::SampleRecord RenderSession::trace_sample(SampleId id) const {
    const PreparedScene& prepared = setup_.prepared;
    return integrator::SampleRecord::of(*prepared.scene, *prepared.bvh, *prepared.lights, path_,
                                        *setup_.view.camera, job_, scene_.size, id);
}

// Samples that every pixel has.
SampleRange RenderSession::complete() const {
    if (job_.noise) return {0, job_.end_sample};
    const uint32_t first = job_.first_sample;
    return {first, first + film_->taken_range().least};
}

io::PictureRows RenderSession::light() const {
    return develop(*film_, complete(), facts_.metadata, denoised_);
}

io::PictureRows RenderSession::shown() const {
    const io::DisplayOptions& d = display_;
    const io::PictureRows rows =
        denoised_ ? denoised_colours(*film_, complete(), {}, denoised_) : light();
    return io::to_display(rows, d.exposure_ev, d.view, io::AlphaUse::Keep, d.config);
}

io::PictureRows RenderSession::picture(const std::filesystem::path& file) const {
    return picture_for(file, {*film_, complete(), facts_, noise(*film_), denoised_});
}

void RenderSession::write(const std::filesystem::path& file) const {
    io::write_output(file, picture(file), display_);
}

FoundExposure RenderSession::find_exposure() {
    return apps::find_exposure(setup_, job_, path_, executor_);
}

}  // namespace petzval::apps
