// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace petzval::apps {
namespace {

constexpr int kUsualColumns = 40;  ///< of a line for nobody knows what

/// Columns that a live line may take: one fewer than the terminal has, or it would wrap.
int terminal_columns() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col - 1
                                                                             : kUsualColumns;
}

/// Milliseconds are enough, and 1e-5 of a whole is.
double to_1e3(double value) {
    return std::round(value * 1e3) / 1e3;
}
double to_1e5(double value) {
    return std::round(value * 1e5) / 1e5;
}

Console::Json json_of(const ProgressFigures& f) {
    Console::Json out{{"phase", kPhaseNames[static_cast<size_t>(Phase::Rendering)]}};
    out["fraction"] = to_1e5(f.fraction);
    out["pixel_samples"] = f.pixel_samples;
    out["samples_per_s"] = std::round(f.samples_per_s);
    out["elapsed_s"] = to_1e3(f.elapsed_s);
    out["remaining_s"] = nullptr;
    if (f.noise > 0) out["noise"] = f.noise;
    if (f.left_s) out["remaining_s"] = to_1e3(*f.left_s);
    return out;
}

}  // namespace

Progress::Progress(ProgressStyle style, Console& console, const integrator::RenderMonitor& monitor,
                   const ProgressGoal& goal)
    : style_(style), console_(console), monitor_(monitor), goal_(goal) {
    if (style_ == ProgressStyle::Auto)
        style_ = isatty(STDERR_FILENO) ? ProgressStyle::Bar : ProgressStyle::Lines;
    if (style_ == ProgressStyle::None) return;
    thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

Progress::~Progress() {
    if (thread_.joinable()) {
        thread_.request_stop();
        thread_.join();
    }
    const std::lock_guard lock(mutex_);
    end_phase();
    if (style_ == ProgressStyle::Bar) console_.live_line("");
}

void Progress::begin(Phase phase) {
    const std::lock_guard lock(mutex_);
    if (phase == phase_) return;
    end_phase();
    phase_ = phase;
    phase_start_s_ = integrator::steady_s();
    if (style_ == ProgressStyle::Json || style_ == ProgressStyle::Bar) show_now();
}

void Progress::end_rendering(bool whole) {
    const std::lock_guard lock(mutex_);
    const uint64_t done = monitor_.pixel_samples_done;
    const ProgressFigures figures =
        whole ? with_noise(figures_at_end(done, phase_s())) : under_way(done);
    rendered_ = true;
    if (style_ == ProgressStyle::Json) console_.event("progress", json_of(figures));
    if (style_ == ProgressStyle::Bar)
        console_.line(progress_line(figures, terminal_columns(), ProgressBar::Yes));
    if (style_ == ProgressStyle::Lines)
        console_.line(progress_line(figures, kUsualColumns, ProgressBar::No));
    if (style_ == ProgressStyle::Percent) show_percent(figures.fraction);
}

ProgressFigures Progress::with_noise(ProgressFigures figures) const {
    if (const double noise = monitor_.noise; std::isfinite(noise)) figures.noise = noise;
    return figures;
}

// Where a noise is to be reached, what is known of the cells says how many samples there will be.
ProgressFigures Progress::under_way(uint64_t done) const {
    ProgressGoal goal = goal_;
    if (const uint64_t expected = monitor_.expected_pixel_samples; expected > 0 && goal.total)
        goal.total = std::max(expected, done + 1);
    return with_noise(figures_under_way(goal, done, phase_s()));
}

void Progress::show_percent(double fraction) {
    const double whole = goal_.part_of.first + fraction;
    const int percent = static_cast<int>(100 * whole / goal_.part_of.second);
    if (percent == percent_) return;
    percent_ = percent;
    console_.line(fmt::format("PROGRESS {}%", percent));
}

void Progress::set_before(uint64_t pixel_samples, double spent_s) {
    const std::lock_guard lock(mutex_);
    goal_.before = pixel_samples;
    goal_.spent_s = spent_s;
}

void Progress::skip() {
    const std::lock_guard lock(mutex_);
    if (style_ == ProgressStyle::Percent) show_percent(1);
}

PhaseTimes Progress::times() const {
    const std::lock_guard lock(mutex_);
    PhaseTimes out = times_;
    if (phase_ != Phase::Count) out[static_cast<size_t>(phase_)] += phase_s();
    return out;
}

double Progress::phase_s() const {
    return integrator::steady_s() - phase_start_s_;
}

void Progress::end_phase() {
    if (phase_ == Phase::Count) return;
    double& total_s = times_[static_cast<size_t>(phase_)];
    total_s += phase_s();
    if (style_ == ProgressStyle::Json)
        console_.event("phase", {{"phase", kPhaseNames[static_cast<size_t>(phase_)]},
                                 {"elapsed_s", to_1e3(total_s)},
                                 {"ended", true}});
    phase_ = Phase::Count;
}

void Progress::watch(const std::stop_token& stop) {
    using namespace std::chrono_literals;
    const auto every =
        style_ == ProgressStyle::Bar || style_ == ProgressStyle::Percent ? 200ms : 2000ms;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex_);
    while (!wake.wait_for(lock, stop, every, [&] { return stop.stop_requested(); }))
        if (phase_ != Phase::Count) show_now();
}

void Progress::show_now() {
    const bool rendering = phase_ == Phase::Rendering;
    if (rendering && rendered_) return;
    const ProgressFigures figures = under_way(monitor_.pixel_samples_done);
    const auto line = [&](int columns, ProgressBar bar) {
        return rendering ? progress_line(figures, columns, bar)
                         : phase_line(phase_, phase_s(), columns);
    };
    if (style_ == ProgressStyle::Bar)
        console_.live_line(line(terminal_columns(), ProgressBar::Yes));
    if (style_ == ProgressStyle::Lines) console_.line(line(kUsualColumns, ProgressBar::No));
    if (style_ == ProgressStyle::Percent && rendering) show_percent(figures.fraction);
    if (style_ != ProgressStyle::Json) return;
    if (rendering)
        console_.event("progress", json_of(figures));
    else
        console_.event("phase", {{"phase", kPhaseNames[static_cast<size_t>(phase_)]},
                                 {"elapsed_s", to_1e3(phase_s())},
                                 {"ended", false}});
}

}  // namespace petzval::apps
