// SPDX-License-Identifier: Apache-2.0
#include "apps/python/bindings.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "apps/chart/chart.h"
#include "apps/plan/plan_json.h"
#include "apps/plan/plan_wording.h"
#include "apps/python/aside.h"
#include "apps/python/image.h"
#include "apps/python/keywords.h"
#include "apps/render/render_session.h"
#include "apps/request/parse.h"
#include "apps/setup/display_setup.h"
#include "apps/state/finished_film.h"
#include "core/math/math.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

namespace py = pybind11;

/// Progress as a callback gets it: phase, pixel samples so far and in all (0: not known), and the
/// noise so far (0: not known).
using OnProgress = std::function<void(const std::string&, uint64_t, uint64_t, double)>;

/// Sets a flag as long as it lives; refuses where another thread has set it.
class OnlyOne {
  public:
    explicit OnlyOne(std::atomic<bool>& busy) : busy_(busy) {
        if (busy_.exchange(true))
            throw ValueError("scene",
                             "renders in another thread; give each thread a Scene of its own");
    }
    ~OnlyOne() { busy_ = false; }
    OnlyOne(const OnlyOne&) = delete;
    OnlyOne& operator=(const OnlyOne&) = delete;

  private:
    std::atomic<bool>& busy_;
};

int threads_or_all(int threads) {
    return threads > 0 ? threads : threads_of(RunRequest());
}

class PythonSession {
  public:
    explicit PythonSession(int threads) {
        require_own_threads();
        session_ = std::make_unique<RenderSession>(threads_or_all(threads));
    }

    /// Stops what renders in another thread, and refuses more.
    void close() {
        closing_ = true;
        const py::gil_scoped_release released;
        while (busy_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }

    std::shared_ptr<RenderedImage> render(const Keywords& keywords, const OnProgress& progress) {
        require_own_threads();
        const OnlyOne only(busy_);
        refuse_when_closing();
        RenderRequest request = order_of(keywords).render;
        integrator::RenderMonitor monitor;
        std::atomic<Phase> phase = Phase::Loading;
        std::atomic<uint64_t> before = 0;  // samples that the film has
        std::shared_ptr<RenderedImage> image;
        std::vector<std::string> notices;
        const auto begin = [&](Phase next) {
            phase = next;
            if (monitor.stop)
                throw std::runtime_error("stopped");  // the caller's exception hides it
        };
        run_aside(
            [&] {
                if (const std::string told = resolve_display(request.display); !told.empty())
                    notices.push_back(told);
                session_->prepare(
                    request, [&](const std::string& line) { notices.push_back(as_keywords(line)); },
                    begin);
                before = session_->film().taken_count();
                begin(Phase::Rendering);
                RenderRun run;
                run.begins = [&](Phase next) { phase = next; };
                if (session_->render(monitor, run).stopped) return;
                if (const auto told = left_out_text(session_->film()))
                    notices.push_back(as_keywords(*told));
                image = std::make_shared<RenderedImage>(*session_, request.scene, notices);
            },
            [&] {
                refuse_when_closing();
                if (!progress) return;
                const Phase now = phase;
                progress(kPhaseNames[static_cast<size_t>(now)], before + monitor.pixel_samples_done,
                         now == Phase::Rendering ? expected(request, monitor) : 0, monitor.noise);
            },
            [&] { monitor.stop = true; });
        return image;
    }

  private:
    void refuse_when_closing() const {
        if (closing_) throw ValueError("scene", "is closed, as Python ends");
    }
    [[nodiscard]] static uint64_t expected(const RenderRequest& request,
                                           const integrator::RenderMonitor& monitor) {
        if (const uint64_t known = monitor.expected_pixel_samples) return known;
        const SampleRequest& samples = request.samples;
        if (samples.noise || samples.time_limit_s) return 0;
        const Rect there = shape_of(request).pixels();
        const SampleRange range =
            samples.range.value_or(SampleRange{0, samples.count.value_or(kUsualSamples)});
        return uint64_t(there.width()) * uint64_t(there.height()) * range.count();
    }

    std::unique_ptr<RenderSession> session_;
    std::atomic<bool> busy_ = false, closing_ = false;
};

// What a plan says, as JSON, and the keywords that carry it out.
py::tuple plan_of(const Keywords& keywords, int threads) {
    require_own_threads();
    const RenderOrder order = order_of(keywords);
    std::string json;
    RenderOrder planned;
    run_aside(
        [&] {
            check(order.render);
            flush_denormals();
            integrator::TbbExecutor executor(threads_or_all(threads));
            const RenderRequest& request = order.render;
            const Plan plan = make_plan(
                {resolved_scene(request), job_of(request), request.path, request.tolerance},
                executor, [](const std::string&) {});
            json = json_of(plan).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
            planned.render = carried_out(plan, request);
        },
        [] {}, [] {});
    py::list fields;  // with bytes, as names of files need not be UTF-8
    for (const auto& [keyword, text] : keywords_of(planned))
        fields.append(py::make_tuple(keyword, py::bytes(text)));
    return py::make_tuple(json, fields);
}

void make_chart(const Keywords& keywords, int threads, const std::string& folder,
                const std::vector<std::string>& axes, const std::string& budget, uint32_t seeds) {
    require_own_threads();
    const RenderOrder order = order_of(keywords);
    integrator::RenderMonitor monitor;
    run_aside(
        [&] {
            flush_denormals();
            integrator::TbbExecutor executor(threads_or_all(threads));
            io::load_image_codec();
            io::limit_picture_threads(executor.threads());
            ChartRequest request;
            request.axes = parse_axes("axes", axes);
            request.budget_s = parse_duration_s("budget", budget);
            request.subject.folder = folder;
            request.frame.seeds = seeds;
            request = chart_of(std::move(request), order.render, "folder");
            (void)run_chart(
                request, executor, monitor, [](const std::string&) {}, [](const MeasuredCase&) {},
                ChartClock());
        },
        [] {}, [&] { monitor.stop = true; });
}

}  // namespace

void bind_session(py::module_& module) {
    py::class_<PythonSession>(module, "Session")
        .def(py::init<int>())
        .def("render", &PythonSession::render)
        .def("close", &PythonSession::close);
    module.attr("MOST_THREADS") = kMostThreads;
    module.attr("LEAST_SEEDS") = kChartSeeds;
    module.attr("MOST_SEEDS") = kMostChartSeeds;
    module.def("plan", plan_of);
    module.def("chart", make_chart);
}

}  // namespace petzval::apps
