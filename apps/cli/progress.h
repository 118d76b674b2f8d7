// SPDX-License-Identifier: Apache-2.0
// Progress of a render on stderr.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "apps/cli/console.h"
#include "apps/cli/progress_text.h"
#include "apps/request/render_order.h"
#include "integrator/render/render_job.h"

namespace petzval::apps {

/// Wall time of each phase, in seconds.
using PhaseTimes = std::array<double, static_cast<size_t>(Phase::Count)>;

/// Shows the phases of a render and its progress from a thread of its own until it is destroyed.
class Progress {
  public:
    Progress(ProgressStyle, Console&, const integrator::RenderMonitor&, const ProgressGoal&);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Begins a phase, which ends the one before. Any thread may call it.
    void begin(Phase);
    /// Shows the last of rendering. whole: it ended by its samples or its time, by no signal.
    void end_rendering(bool whole);
    /// Sets what an earlier run has done: pixel samples, and the time that they took.
    void set_before(uint64_t pixel_samples, double spent_s);
    /// Ends a picture that need not be rendered.
    void skip();
    /// Times of the phases so far.
    [[nodiscard]] PhaseTimes times() const;

  private:
    void watch(const std::stop_token&);
    void show_now();
    void show_percent(double fraction);
    void end_phase();
    [[nodiscard]] ProgressFigures with_noise(ProgressFigures) const;
    [[nodiscard]] ProgressFigures under_way(uint64_t pixel_samples) const;
    [[nodiscard]] double phase_s() const;

    ProgressStyle style_;
    Console& console_;
    const integrator::RenderMonitor& monitor_;
    ProgressGoal goal_;
    mutable std::mutex mutex_;
    Phase phase_ = Phase::Count;  ///< none yet
    double phase_start_s_ = 0;
    bool rendered_ = false;
    int percent_ = -1;  ///< shown last
    PhaseTimes times_{};
    std::jthread thread_;
};

}  // namespace petzval::apps
