// SPDX-License-Identifier: Apache-2.0
#include "apps/live/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "apps/live/rough.h"
#include "apps/plan/plan_wording.h"
#include "apps/request/parse.h"
#include "apps/setup/display_setup.h"
#include "apps/state/finished_film.h"
#include "integrator/prepass/autofocus.h"
#include "io/base/error.h"
#include "io/image/display.h"

namespace petzval::apps {
namespace {

/// A newer request came.
struct Outdated {};

io::ArgumentError other_picture() {
    return {"picture", "", "is another one by now"};
}

// 8 bits as PNG files have them.
LivePicture picture_of(const io::PictureRows& shown) {
    LivePicture out{{shown.layout.width, shown.layout.height}, {}};
    const size_t row_size = size_t(out.size_px.x) * 4;
    out.rgba.resize(row_size * size_t(out.size_px.y));
    std::vector<float> row(row_size);
    for (int y = 0; y < out.size_px.y; ++y) {
        shown.row(y, row.data());
        std::ranges::transform(row, out.rgba.begin() + std::ptrdiff_t(row_size) * y, [](float v) {
            return static_cast<uint8_t>(std::lround(std::clamp(v, 0.f, 1.f) * 255));
        });
    }
    return out;
}

LiveCamera camera_of(const RenderSetup& setup) {
    const CameraReport& camera = setup.from.camera;
    const PreparedScene& prepared = setup.prepared;
    const V3f axis = (camera.target - camera.eye).normalized();
    return {text_of_pose(camera.to_world),
            setup.view.of_file ? std::to_string(*setup.view.of_file) : "",
            camera.focus_m,
            camera.sensor_mm,
            camera.yfov_deg,
            integrator::depth_under(*prepared.scene, *prepared.bvh, *setup.view.finder, camera.eye,
                                    axis, {0.5f, 0.5f})};
}

// Another text where a file of the scene was changed.
std::string stamp_of(const LoadedScene& loaded) {
    std::string out;
    std::error_code none;
    const auto add = [&](const std::filesystem::path& file) {
        out += fmt::format("{} {};", std::filesystem::file_size(file, none),
                           std::filesystem::last_write_time(file, none).time_since_epoch().count());
    };
    for (const io::NamedFile& file : loaded.prepared.files) add(file.path);
    if (loaded.prepared.environment) add(*loaded.prepared.environment);
    return out;
}

/// Asks a render to pause now and then as long as it lives, often at first.
class Pauses {
  public:
    explicit Pauses(integrator::RenderMonitor& monitor)
        : thread_([this, &monitor](const std::stop_token& end) {
              double wait_s = 0.05;
              std::unique_lock lock(mutex_);
              for (; !end.stop_requested(); wait_s = std::min(1.2 * wait_s, 1.)) {
                  wake_.wait_for(lock, end, std::chrono::duration<double>(wait_s),
                                 [] { return false; });
                  monitor.pause = true;
              }
          }) {}

  private:
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread thread_;  // last: it uses the others
};

}  // namespace

Viewer::Viewer(int threads, SharedScene scene)
    : scene_(std::move(scene)),
      session_(threads),
      thread_([this](const std::stop_token& end) { work(end); }) {
    session_.take(scene_.loaded);
}

Viewer::~Viewer() {
    leave();
    thread_.request_stop();
}

void Viewer::ask(uint64_t version, RenderRequest request) {
    const std::lock_guard lock(mutex_);
    next_ = Job{++ticket_, version, std::move(request)};
    if (running_) running_->stop = true;
    changed_.notify_all();
}

void Viewer::leave() {
    const std::lock_guard lock(mutex_);
    ++ticket_;
    next_.reset();
    if (running_) running_->stop = true;
}

LiveStatus Viewer::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

LiveStatus Viewer::wait(uint64_t number, std::chrono::milliseconds most) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [&] { return status_.number != number; });
    return status_;
}

std::shared_ptr<const LivePicture> Viewer::picture() const {
    const std::lock_guard lock(mutex_);
    return picture_;
}

SharedScene Viewer::scene() const {
    const std::lock_guard lock(mutex_);
    return scene_;
}

void Viewer::inspect(uint64_t version, const std::function<void(const RenderSession&)>& f) {
    std::future<void> answered;
    {
        const std::lock_guard lock(mutex_);
        const bool is_true =
            status_.stage == LiveStage::Growing || status_.stage == LiveStage::Done;
        if (!is_true || status_.version != version) throw other_picture();
        answered = questions_.emplace_back(f).answered.get_future();
        if (running_) running_->pause = true;
        changed_.notify_all();
    }
    answered.get();
}

void Viewer::write(uint64_t version, const std::filesystem::path& file) {
    inspect(version, [&](const RenderSession& session) {
        if (status().stage != LiveStage::Done)
            throw io::ArgumentError("picture", "",
                                    "is not done yet; wait until all samples are there");
        session.write(file);
    });
}

void Viewer::answer_questions() {
    std::vector<Question> all;
    {
        const std::lock_guard lock(mutex_);
        all.swap(questions_);
    }
    for (Question& one : all) try {
            one.f(session_);
            one.answered.set_value();
        } catch (...) {
            one.answered.set_exception(std::current_exception());
        }
}

void Viewer::refuse_questions() {
    const std::lock_guard lock(mutex_);
    for (Question& one : questions_)
        one.answered.set_exception(std::make_exception_ptr(other_picture()));
    questions_.clear();
}

bool Viewer::stale(const Job& job) const {
    const std::lock_guard lock(mutex_);
    return job.ticket != ticket_;
}

// What is of an older request is not published: the status would go back in time.
void Viewer::publish(const Job& job, const std::function<void(LiveStatus&)>& change,
                     std::shared_ptr<const LivePicture> picture) {
    const std::lock_guard lock(mutex_);
    if (job.ticket != ticket_) throw Outdated();
    status_.version = job.version;
    ++status_.number;
    if (picture) {
        picture_ = std::move(picture);
        status_.picture = status_.number;
    }
    change(status_);
    changed_.notify_all();
}

void Viewer::work(const std::stop_token& end) {
    for (;;) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, end, [&] { return next_ || !questions_.empty(); });
        const bool goes_on = !end.stop_requested();
        const std::optional<Job> asked = std::exchange(next_, std::nullopt);
        lock.unlock();
        if (goes_on && !asked) answer_questions();
        if (!goes_on || asked) refuse_questions();
        if (!goes_on) return;
        if (!asked) continue;
        const Job& job = *asked;
        try {
            try {
                show(job);
            } catch (const std::exception& error) {
                rendered_.reset();
                publish(job, [&](LiveStatus& now) {
                    now.stage = LiveStage::Failed;
                    now.error = error.what();
                });
            }
        } catch (const Outdated&) {
            refuse_questions();
        }
    }
}

void Viewer::show(const Job& job) {
    publish(job, [](LiveStatus& now) {
        now.stage = LiveStage::Preparing;
        now.phase = Phase::Loading;
        now.samples = now.of = 0;
        now.noise = now.elapsed_s = 0;
        now.notices.clear();
        now.error.clear();
    });
    if (!rendered_ || !keeps_samples(*rendered_, job.request)) try {
            show_rough(job);
        } catch (const std::exception&) {
            // Whatever is wrong, the true one tells: what is asked for may be right without haste.
        }
    show_true(job);
}

void Viewer::prepare(const Job& job, const RenderRequest& asked,
                     std::vector<std::string>& notices) {
    rendered_.reset();
    RenderRequest request = asked;
    if (const std::string told = resolve_display(request.display); !told.empty())
        notices.push_back(told);
    const SharedScene before = scene();
    if (before.loaded.prepared.scene && stamp_of(before.loaded) != before.stamp) {
        session_.take({});
        notices.emplace_back("the files of the scene have changed; they were read anew");
    }
    size_t told_in_loading = 0;
    session_.prepare(
        request, [&](const std::string& line) { notices.push_back(line); },
        [&](Phase phase) {
            if (phase == Phase::Bvh) told_in_loading = notices.size();
            if (stale(job)) throw Outdated();
            if (phase != status().phase) publish(job, [&](LiveStatus& now) { now.phase = phase; });
        });
    LoadedScene now = session_.scene();
    if (now.prepared.scene == before.loaded.prepared.scene) return;
    std::string stamp = stamp_of(now);
    const std::lock_guard lock(mutex_);
    scene_ = {std::move(now),
              std::move(stamp),
              {notices.begin(), notices.begin() + std::ptrdiff_t(told_in_loading)}};
}

void Viewer::render(const Job& job, integrator::RenderMonitor& monitor, const RenderRun& run) {
    {
        const std::lock_guard lock(mutex_);
        if (job.ticket != ticket_) throw Outdated();
        running_ = &monitor;
    }
    const auto forget = [&](const void*) {
        const std::lock_guard lock(mutex_);
        running_ = nullptr;
    };
    const std::unique_ptr<const void, decltype(forget)> guard(this, forget);
    if (session_.render(monitor, run).stopped) throw Outdated();
}

void Viewer::show_rough(const Job& job) {
    const V2i size = job.request.scene.size;
    const RenderRequest rough =
        rough_of(job.request, rough_divisor(size, samples_per_s_, set_up_s_));
    std::vector<std::string> unheard;
    const double asked_s = integrator::steady_s();
    prepare(job, rough, unheard);
    const double start_s = integrator::steady_s();
    set_up_s_ = start_s - asked_s;
    integrator::RenderMonitor monitor;
    render(job, monitor, {});
    samples_per_s_ = double(rough.scene.size.x) * rough.scene.size.y /
                     std::max(integrator::steady_s() - start_s, 1e-4);
    publish(
        job,
        [&](LiveStatus& now) {
            now.stage = LiveStage::Rough;
            now.camera = camera_of(session_.setup());
        },
        std::make_shared<const LivePicture>(picture_of(session_.shown())));
}

void Viewer::show_true(const Job& job) {
    std::vector<std::string> notices;
    const double start_s = integrator::steady_s();
    prepare(job, job.request, notices);
    // Who shares a scene does so in silence.
    for (const std::string& line : scene().notices)
        if (std::ranges::find(notices, line) == notices.end()) notices.push_back(line);
    rendered_ = job.request;
    const LiveCamera camera = camera_of(session_.setup());
    const std::vector<std::string> channels = session_.light().layout.channels;
    const SampleRequest& samples = job.request.samples;
    integrator::RenderMonitor monitor;
    double look_s = 0, looked_s = 0;  // a denoised picture takes its time
    const auto shown = [&](const io::Picture& light) {
        const io::DisplayOptions& d = session_.display();
        return picture_of(
            io::to_display(light, d.exposure_ev, d.view, io::AlphaUse::Keep, d.config));
    };
    const auto publish_picture = [&](LiveStage stage) {
        const LivePicture seen = stage == LiveStage::Growing && job.request.denoise
                                     ? shown(session_.look(monitor))
                                     : picture_of(session_.shown());
        publish(
            job,
            [&](LiveStatus& now) {
                now.stage = stage;
                now.phase = Phase::Rendering;
                now.samples = session_.film().taken_range().least;
                now.of = samples.noise || samples.time_limit_s ? 0
                         : samples.range                       ? samples.range->count()
                                         : samples.count.value_or(kUsualSamples);
                now.noise = monitor.noise;
                now.elapsed_s = integrator::steady_s() - start_s;
                now.camera = camera;
                now.channels = channels;
                now.notices = notices;
            },
            std::make_shared<const LivePicture>(seen));
    };
    RenderRun run;
    run.at_pause = [&](const integrator::PathStats&) {
        answer_questions();
        if (session_.film().taken_range().least == 0) return;  // the rough one has no holes
        const double now_s = integrator::steady_s();
        if (now_s - looked_s < 4 * look_s) return;
        publish_picture(LiveStage::Growing);
        looked_s = integrator::steady_s();
        look_s = looked_s - now_s;
    };
    {
        const Pauses pauses(monitor);
        render(job, monitor, run);
    }
    if (const auto told = left_out_text(session_.film())) notices.push_back(*told);
    if (const auto reached = session_.noise(session_.film()))
        notices.push_back(text_of(*reached, *samples.noise));
    publish_picture(LiveStage::Done);
}

}  // namespace petzval::apps
